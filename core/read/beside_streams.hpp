#pragma once
/// What a log of a journey holds beside its inertial stream: satellite fixes, an odometer. Internal to core/read.
///
/// Each such stream has a clock and a rate of its own, and stands in the recording's table in columns of its own, the
/// first of which is its time: `gnss_time (s)`, `gnss_latitude (deg)`, ... A second stream of one kind is `gnss2_...`.
/// Its rows begin with the table's and say nothing of the rows beside them; behind its last one the columns have ended
/// (core/signal/missing.hpp). Times count from the zero of the inertial stream's, and so may be below zero.
///
/// Rows wait until the end of the file, in 64 MiB (a million fixes). What is more is left out, with a note, and so are
/// streams beyond the sixteenth.
#include "core/read/format.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

class BesideStreams {
 public:
  /// A stream whose columns, without its time, are called `kind`_`column`.
  [[nodiscard]] std::size_t add(std::string name, std::string kind, ColumnNames columns);

  /// The next row. A value that is not finite is a missing sample.
  void take(std::size_t stream, std::uint64_t stamp, std::span<const double> values);

  /// No row so far.
  [[nodiscard]] bool empty() const;

  /// The names of their columns in the table. A stream without a row so far is not in it.
  [[nodiscard]] ColumnNames settle();

  /// Behind settle: the earliest of their first stamps, and the rows of the longest.
  [[nodiscard]] std::uint64_t first_stamp() const;
  [[nodiscard]] std::size_t longest() const;

  /// Fills the columns from `column` on of a table of `rows` rows, times in seconds since `origin`, with a note of what
  /// did not fit. Errors: those of the sink.
  [[nodiscard]] Status deliver(ColumnSink& sink, std::size_t column, std::size_t rows, std::uint64_t origin,
                               double ticks_per_s) const;

 private:
  struct Stream {
    std::string name;
    std::string kind;
    ColumnNames columns;
    std::string heading;  ///< of its columns in the table; empty where it is not in it
    std::vector<std::uint64_t> stamps;
    std::vector<double> values;  ///< row-major
    std::uint64_t left_out = 0;

    [[nodiscard]] bool in_table() const { return !heading.empty(); }
  };
  [[nodiscard]] Status deliver_one(ColumnSink& sink, const Stream& stream, std::size_t column, std::size_t rows,
                                   std::uint64_t origin, double ticks_per_s) const;

  std::vector<Stream> streams_;
  std::size_t bytes_ = 0;
  bool settled_ = false;
};

}  // namespace driftlab
