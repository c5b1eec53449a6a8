#pragma once
/// One recording out of a file that holds several inertial streams, each on its own clock. Internal to core/read.
///
/// Logs of flight controllers and robots hold many streams at several rates; a recording is one table on one clock.
/// Every such format uses one rule. Among the streams with gyroscope and accelerometer the one with the most samples is
/// taken, which is the one with the highest rate, since all are counted over the same stretch of the file. Without such
/// a stream the rule is applied to streams with a gyroscope alone, then to those with an accelerometer alone. If
/// several streams tie, the first in the file is taken.
///
/// The other inertial streams stand in the table in columns of their own, `imu2_time (s)`, `imu2_gyro_x (rad/s)`, ...,
/// `imu3_...`, in the order of the file: the recording whose `stream` is `imu2` is that of the second unit
/// (core/signal/column_streams.hpp). Their times count from their own first sample. They have as many rows as the
/// chosen stream: behind a shorter one its sensors have ended while its time goes on at its mean step, and of a longer
/// one the rest is left out, with a note; one that is more than 20 times slower is not in the table. Fixes and
/// odometers of the same journey stand behind them (core/read/beside_streams.hpp); a file that holds only those becomes
/// a table of them.
///
/// The rule is applied at the end of the file or when 16 MiB of samples are waiting, whichever is first: from there on
/// the streams pass through, and those that begin later are counted. Memory: those 16 MiB, and as much for rows of
/// streams that run ahead of the chosen one.
#include "core/read/beside_streams.hpp"
#include "core/read/format.hpp"
#include "core/signal/name_list.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab {

/// What a stream measures, the poorest first.
enum class Inertial { Accelerometer, Gyroscope, Both };

/// The columns of a stream in SI behind its time: gyro_x (rad/s), ..., acc_x (m/s^2), ...
[[nodiscard]] ColumnNames inertial_columns(Inertial holds);

/// `name` from a file, fit for a sentence: printable ASCII, at most 80 characters, in quotes.
[[nodiscard]] std::string quoted_name(std::string_view name);

/// Names of a file in one sentence.
inline constexpr std::size_t kMostNames = 12;

class InertialStreams {
 public:
  /// Stamps count `ticks_per_s`. The sink's begin() is called when the choice is made.
  InertialStreams(ColumnSink& sink, double ticks_per_s) : sink_(sink), ticks_per_s_(ticks_per_s) {}

  /// A stream and its columns without the time. Error: LimitExceeded above 256 streams.
  [[nodiscard]] Result<std::size_t> add(std::string name, Inertial holds, ColumnNames columns);

  /// The next sample of a stream. Its time is that since the stream's first sample; a value that is not finite is a
  /// missing sample. Errors: those of the sink.
  [[nodiscard]] Status take(std::size_t stream, std::uint64_t stamp, std::span<const double> values);

  /// A stream of another kind, and its next row (core/read/beside_streams.hpp). One whose first row comes when the
  /// choice is made is left out, with a note.
  [[nodiscard]] std::size_t add_beside(std::string name, std::string kind, ColumnNames columns) {
    return beside_.add(std::move(name), std::move(kind), std::move(columns));
  }
  void take_beside(std::size_t stream, std::uint64_t stamp, std::span<const double> values) {
    beside_.take(stream, stamp, values);
  }

  /// No sample so far.
  [[nodiscard]] bool empty() const { return samples_ == 0 && beside_.empty(); }

  /// Delivers what is left and notes what was left out. Error: NoSamples, with `nothing` as its sentence.
  [[nodiscard]] Status finish(const std::string& nothing);

 private:
  struct Stream {
    std::string name;
    Inertial holds;
    ColumnNames columns;
    std::vector<double> waiting;  ///< rows until the choice is made, and a batch of them afterwards
    std::uint64_t first = 0;
    std::uint64_t samples = 0;
    std::string heading = {};  ///< of another stream that is in the table: `imu2`
    std::size_t column = 0;    ///< its first one in the table
    std::size_t rows = 0;      ///< delivered
    double last_s = 0.0;       ///< time of the last of them
    bool full = false;         ///< no more rows are taken

    [[nodiscard]] std::size_t width() const { return columns.size() + 1; }
    [[nodiscard]] std::size_t waiting_rows() const { return waiting.size() / width(); }
  };
  [[nodiscard]] Status choose();
  [[nodiscard]] std::size_t best() const;
  [[nodiscard]] Status advance(Stream& stream);
  [[nodiscard]] Status flush(Stream& stream, std::size_t count);
  [[nodiscard]] Status flush_rows(const Stream& stream);
  [[nodiscard]] Status flush_columns(const Stream& stream, std::size_t count);
  [[nodiscard]] Status finish_other(Stream& stream);
  [[nodiscard]] Status finish_alone();
  void note_others();

  ColumnSink& sink_;
  double ticks_per_s_;
  std::vector<Stream> streams_;
  BesideStreams beside_;
  bool alone_ = true;  ///< the table holds nothing beside the chosen stream
  std::size_t chosen_ = static_cast<std::size_t>(-1);
  std::size_t waiting_bytes_ = 0;
  std::size_t beside_column_ = 0;  ///< the first of what is beside the inertial streams
  std::uint64_t samples_ = 0;
};

}  // namespace driftlab
