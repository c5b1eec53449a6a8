#pragma once
/// The one loader of recordings of a device: what each column of a file means, and what drove the sensors.
///
/// Variances (core/signal/recording_view.hpp), calibrations and investigations (core/investigate/study/study.hpp) all
/// ask here which column is the time, which the temperature and which the reference of a sensor, and what a
/// condition says where there is no such column (spec/study.md), which columns are examined at all, and which of their
/// samples are none. They differ only in what they then do with sound samples: a view takes the rows, and leaves a
/// frozen sensor out; a study puts them on a grid, and names the freeze.
///
/// A drive has several files, each on a clock of its own, and quantities that no device has (fixes, a course, an
/// accuracy): core/navigate/drive/table.hpp reads them. Both find a named column by find_column.hpp.
#include "core/signal/channel_survey.hpp"
#include "core/signal/guess_time.hpp"
#include "core/signal/recording.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// 0, 1, 2 for x, y, z; nothing for another label.
[[nodiscard]] std::optional<std::size_t> axis_index(std::string_view axis);

/// The column that a sensor's reference comes from.
struct ReferenceColumn {
  std::size_t index = 0;
  bool angle = false;  ///< an angle, whose derivative is the reference (core/signal/turns.hpp)
};

/// What is done with a column where sensors are examined.
struct ColumnUse {
  bool examined = false;
  std::string note;            ///< why it is not, or that its unit is not stated; empty
  std::optional<Error> fault;  ///< of its values, where they are why it is not
};

/// A file's columns with their roles. Copies are cheap but for the names; samples stay where they are.
class RecordingColumns {
 public:
  /// `column(i)` gives the samples of column i of the file in its own unit; they must outlive this object.
  using Samples = std::function<std::span<const double>(std::size_t)>;

  /// Errors: those of assign_roles.
  [[nodiscard]] static Result<RecordingColumns> read(const RecordingSpec& spec, const ColumnNames& names,
                                                     Samples column);

  [[nodiscard]] std::size_t count() const { return names_.size(); }
  [[nodiscard]] const std::string& name(std::size_t index) const { return names_[index]; }
  /// Nothing for a column that was not named.
  [[nodiscard]] const std::optional<ColumnRole>& role(std::size_t index) const { return roles_[index]; }
  [[nodiscard]] std::span<const double> samples(std::size_t index) const { return column_(index); }
  /// The stated unit of a column, else `otherwise`.
  [[nodiscard]] Unit unit(std::size_t index, const Unit& otherwise = {}) const;
  /// The samples of a column in SI.
  [[nodiscard]] std::vector<double> si(std::size_t index, const Unit& otherwise = {}) const;

  /// The first column of a quantity along an axis (empty: a quantity without axes).
  [[nodiscard]] std::optional<std::size_t> find(Quantity quantity, std::string_view axis = "") const;
  /// The time column. A column that was only guessed from its name and holds text does not count.
  [[nodiscard]] std::optional<std::size_t> time() const;
  /// A column that is a time by its numbers, where none is by its name.
  [[nodiscard]] std::optional<TimeGuess> guessed_time() const { return guess_time(names_, roles_, column_); }
  /// The column that would be the time() but for its text; empty: none.
  [[nodiscard]] std::string time_of_text() const;
  /// The reference of a sensor along an axis: its own column, else for a rate the angle's.
  [[nodiscard]] std::optional<ReferenceColumn> reference_of(Quantity sensor, std::string_view axis) const;

  /// Whether a column is examined as a sensor. Where the roles come from names and one of them is a gyroscope or an
  /// accelerometer, columns whose names say nothing are passed over; note_of_skipped() says which. Errors: those of
  /// check_holes, of a column that is a sensor beyond doubt.
  [[nodiscard]] Result<ColumnUse> use_of(std::size_t index, const Passed& passed = {}) const;
  /// Survey of a sensor column; a row whose reference is missing is unsound as well.
  [[nodiscard]] ChannelSurvey survey(std::size_t index, const Passed& passed = {}) const;

  /// Whether these are the fixes of a receiver alone, by the names that the readers of .pos, NMEA and UBX and of logs
  /// give them: other tables with a latitude may be those of a vehicle, whose sensors have names of their own.
  [[nodiscard]] bool are_fixes() const;

  /// Sentences for the recording's notes: a column that would be the time but for its text, or is it by its name alone
  /// beside stated ones (empty: neither), and those that use_of() passes over (empty: none).
  [[nodiscard]] std::string note_of_time() const;
  [[nodiscard]] std::string note_of_skipped() const;

 private:
  [[nodiscard]] bool has_inertial() const;
  [[nodiscard]] bool is_skipped(std::size_t index) const;

  RecordingColumns(ColumnNames names, std::vector<std::optional<ColumnRole>> roles, Samples column, bool guessed,
                   bool time_stated);

  ColumnNames names_;
  std::vector<std::optional<ColumnRole>> roles_;
  Samples column_;
  bool guessed_;                 ///< the roles come from names
  bool time_stated_;             ///< the time column is stated, not guessed
  std::vector<bool> of_others_;  ///< columns of other streams
};

/// The rate about `axis` [rad/s] that a condition states at `time_s` after the first sample of the file: the constant
/// rate, the ramp from rest, else 0.
[[nodiscard]] double stated_rate(const Condition& condition, std::string_view axis, double time_s);

}  // namespace driftlab
