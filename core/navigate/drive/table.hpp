#pragma once
/// The rows of one source of a drive, as they were decoded, and the moments that they belong to.
#include "core/navigate/drive/document.hpp"
#include "core/signal/recording.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::drive {

struct Table {
  ColumnNames names;
  std::vector<std::vector<double>> columns;
  std::optional<TimeTag> tag;
  std::vector<std::string> notes;  ///< what the decoding had to say

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// The repairs that were made to the stamps of one source.
struct StampFacts {
  std::size_t rows = 0;
  std::size_t without_stamp = 0;  ///< rows left out: no stamp
  std::size_t backward = 0;       ///< rows left out: their stamp lies before the one before
  std::size_t week_rollovers = 0;
  double leap_seconds = 0.0;  ///< added to the first row, for UTC
  bool leap_within = false;   ///< one more was added to the rows behind a leap second
};

/// A row and its stamp [s]: on GPS time in seconds since 1970 for Gps, Utc, Unix and tagged files, else on the source's
/// own clock.
struct StampedRows {
  std::vector<std::size_t> row;
  std::vector<double> time_s;
  bool absolute = false;  ///< on GPS time
  StampFacts facts;
};

/// UTC is GPS time minus this many seconds at a moment in seconds since 1970 (IERS Bulletin C; 18 s since 2017).
[[nodiscard]] double leap_seconds_at(double unix_s);

/// The error with the file that it concerns, in its sentence and as the field "file".
[[nodiscard]] Error of_file(Error error, const std::string& file);

/// The column with a quantity along an axis in SI; nothing where the source has none. Error: UnknownColumn.
[[nodiscard]] Result<std::optional<std::vector<double>>> find_quantity(const Table& table, const Source& source,
                                                                       Quantity quantity, std::string_view axis = "");

/// A channel of the inertial unit.
struct UnitChannel {
  std::vector<double>
      values;              ///< SI; NaN where the cell is empty or holds a number that stands for none, such as -9999
  ChannelQuality quality;  ///< by the survey that every recording has (core/signal/channel_survey.hpp)
};

/// The same for a sensor of the inertial unit. A cell without a number makes its row incomplete and is no fault, unless
/// all are such. Errors: UnknownColumn, where no column has the quantity along the axis; those of check_holes, of a
/// column that holds no number.
[[nodiscard]] Result<UnitChannel> find_unit_channel(const Table& table, const Source& source, Quantity quantity,
                                                    std::string_view axis);

/// Rows in the order of time. A counter of seconds of the week that starts again goes on; rows without a stamp or with
/// one before the row before are left out and counted. Errors: UnknownColumn; TooFewSamples; NonMonotonicTime (more
/// than one row in a hundred steps back); InvalidArgument (no rate for rows without a clock).
[[nodiscard]] Result<StampedRows> stamp_rows(const Table& table, const TimeMeaning& meaning);

}  // namespace driftlab::drive
