#pragma once
/// A recording: the meaning of its columns and the dynamic condition under which it was made.
///
/// The samples themselves are in a column table in the file's own units (core/read/column_file.hpp maps one from disk);
/// this header holds their *meaning*. One `RecordingSpec` is one member of `recordings` in spec/study.md.
#include "core/signal/condition.hpp"
#include "core/signal/gappy_samples.hpp"
#include "core/signal/quantity.hpp"
#include "core/signal/result.hpp"
#include "core/signal/unit.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// The meaning of one column.
struct ColumnRole {
  Quantity quantity = Quantity::Unspecified;
  std::string axis;          ///< "x", ...; empty where the quantity has none
  std::optional<Unit> unit;  ///< empty: not stated; the channel is then in unit `1`, with a note

  friend bool operator==(const ColumnRole&, const ColumnRole&) = default;
};

/// Seconds left out at both ends of the file before analysis.
struct Trim {
  double start_s = 0.0;
  double end_s = 0.0;
  friend bool operator==(const Trim&, const Trim&) = default;
};

/// Sampling rates that a sensor can have: from one sample in twelve days to a gigahertz. Times and frequencies computed
/// from them stay finite.
[[nodiscard]] constexpr bool is_sampling_rate(double rate_hz) { return rate_hz >= 1e-6 && rate_hz <= 1e9; }

/// What the user says about a file. `columns` is keyed by the file's own column names, or by column number from "0". If
/// it is empty, the roles are inferred from names and units in the header (core/signal/infer_role.hpp), of the columns
/// of `stream` alone where one is stated (core/signal/column_streams.hpp).
struct RecordingSpec {
  std::string id;                 ///< the user's name for the recording; may be empty
  std::optional<double> rate_hz;  ///< nominal rate; needed where there is no time column
  std::map<std::string, ColumnRole> columns;
  std::string stream;  ///< of the units in the table the one that is meant, as its columns begin: `imu2`; may be empty
  Condition condition;
  Trim trim;
  std::string calibration;  ///< reference to the calibration of the readings: a file or an id; empty: none

  friend bool operator==(const RecordingSpec&, const RecordingSpec&) = default;
};

/// Checks one role in itself: the unit measures the quantity, the axis belongs to it.
[[nodiscard]] Status check_role(const std::string& column, const ColumnRole& role);

/// A file's columns by name, without their samples.
using ColumnNames = std::vector<std::string>;

/// A role for each column of the file, in file order; nothing for a column that is not needed. With `spec.columns`: the
/// names must exist, no two columns may have the same (quantity, axis), and each role must check. Without, and for the
/// other columns where `spec.columns` names the time alone: names such
/// as `gx`, `gyro_x`, `wx [deg/s]`, `acc_z (m/s^2)`, `temp`, `t`, `time (s)` are understood; other columns become
/// unspecified channels in unit `1`, and those of other streams have no role. Errors: UnknownColumn, DuplicateColumn,
/// UnitMismatch, InvalidArgument; each names the column.
[[nodiscard]] Result<std::vector<std::optional<ColumnRole>>> assign_roles(const RecordingSpec& spec,
                                                                          const ColumnNames& names);

/// How the samples lie in time.
struct TimeBase {
  double dt_s = 0.0;     ///< sample interval: 1/rate_hz, or where a time column disagrees or is alone, the mean step of
                         ///< the analysed stretch
  double start_s = 0.0;  ///< first time stamp, 0 without a time column
  double first_s = 0.0;  ///< time of the first analysed row since the first row of the file

  [[nodiscard]] double rate_hz() const { return 1.0 / dt_s; }
};

/// Facts of one sensor channel as recorded (found by core/signal/channel_survey.hpp). Counts are over the whole
/// file.
struct ChannelQuality {
  std::string column;
  std::size_t missing = 0;      ///< cells without a number: empty, NaN, or beyond the end of the column
  std::size_t implausible = 0;  ///< numbers that mean "missing" (-9999) or are garbage (-1.7e38); taken as missing
  std::size_t repeated = 0;     ///< samples equal to the one before
  std::optional<std::size_t> distinct;  ///< distinct values; nothing above 256
  double resolution = 0.0;              ///< step of the lattice the values lie on [channel unit]; 0 where there is none
  std::size_t saturated = 0;            ///< samples at a full-scale value
  std::size_t frozen = 0;               ///< samples of a stretch in which the sensor gives one value only
  std::size_t frozen_from = 0;          ///< its first sample, from 1
  std::size_t first = 0;                ///< first analysed sample, from 1
  std::size_t last = 0;                 ///< last analysed sample
  std::size_t analysed = 0;             ///< samples analysed: those of [first, last] without any of the above
};

/// Facts of the recording as it came; they are reported and never silently repaired.
struct Quality {
  std::size_t samples = 0;          ///< rows of the file, less those that repeat the row before
  std::size_t repeated_rows = 0;    ///< rows with the stamp and all values of the row before: one sample written twice
  std::size_t analysed = 0;         ///< rows of the analysed part, after trims
  std::size_t missing = 0;          ///< samples that the time column says are missing between them
  std::size_t gaps = 0;             ///< steps of the time column longer than 1.5 intervals of the samples they join
  std::size_t repeated_stamps = 0;  ///< steps of the time column equal to 0
  std::size_t backward_steps = 0;   ///< steps of the time column below 0 that are no counter wrap
  std::size_t counter_wraps = 0;    ///< times a counter of 16 or 32 bits in the time column started again
  bool bursts = false;              ///< stamps given on arrival: many samples at once, then none for long
  double longest_gap_s = 0.0;
  double jitter_s = 0.0;              ///< half the distance of the 5 % and 95 % quantiles of the steps
  double measured_rate_hz = 0.0;      ///< (samples - 1) / time advanced; 0 without a time column
  std::optional<double> clock_ratio;  ///< measured over stated rate of the analysed stretch, where both are there
  std::vector<ChannelQuality> channels;
  std::vector<std::string> notes;  ///< sentences: unnamed columns, missing units, parts left out

  /// What is said of a column, or nullptr.
  [[nodiscard]] const ChannelQuality* of(std::string_view column) const;
};

/// Samples of a column in a stretch in which the sensor gives one value only; 0 where the quality does not speak of the
/// column.
[[nodiscard]] std::size_t frozen_samples(const Quality& quality, std::string_view column);

/// The time base and the rows to analyse of a recording.
struct Window {
  TimeBase time;
  std::size_t first = 0;  ///< first analysed row
  std::size_t count = 0;  ///< analysed rows
  std::vector<Gap> gaps;  ///< rows of the file, inside the window, before which samples are missing
  Quality quality;

  /// The time that the analysed samples and those missing between them stand for [s].
  [[nodiscard]] double duration_s() const { return static_cast<double>(count + quality.missing) * time.dt_s; }
};

/// Decides which rows are analysed and on which time base, from the time column (in `time_unit`; an empty span: none),
/// the stated rate and the trims. If the time column has gaps, the rows analysed are one stretch with gaps
/// (core/signal/stretch.hpp); if it steps back, the part before or after the step. A note in `quality` says what is
/// left out. Samples lost at random leave steps that are whole multiples of the sample interval, however many they are
/// (core/signal/sample_grid.hpp). Elsewhere the number missing in a gap is counted on the grid of the sample interval
/// from the rows on both sides, so that a late stamp which the next ones make up for counts as none; and stamps in
/// bursts (more than 2 % of the steps look like gaps) are replaced by those of evenly spaced samples. Errors:
/// InconsistentSampling (neither rate nor time column, or they differ by more than 1 %), NonMonotonicTime (one row in a
/// thousand or more steps back; names the first), NonFinite, TooFewSamples (names the parameter if a trim leaves
/// nothing), InvalidArgument. O(rows) time, and O(rows) memory for the median step.
[[nodiscard]] Result<Window> plan_window(const RecordingSpec& spec, std::size_t rows,
                                         std::span<const double> time_column, const Unit& time_unit);

}  // namespace driftlab
