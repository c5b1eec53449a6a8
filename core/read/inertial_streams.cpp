#include "core/read/inertial_streams.hpp"

#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <cmath>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr std::size_t kMostStreams = 256;
constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20;
constexpr std::size_t kMostAheadBytes = std::size_t{1} << 20;
constexpr std::size_t kBatch = 8192;
constexpr std::size_t kLongestName = 80;
constexpr std::size_t kMostInTable = 16;
constexpr std::uint64_t kMostTimesSlower = 20;

std::string_view contents_of(Inertial holds) {
  switch (holds) {
    case Inertial::Both:
      return "gyroscope and accelerometer";
    case Inertial::Gyroscope:
      return "gyroscope alone";
    case Inertial::Accelerometer:
      break;
  }
  return "accelerometer alone";
}

}  // namespace

ColumnNames inertial_columns(Inertial holds) {
  ColumnNames names;
  if (holds != Inertial::Accelerometer) {
    names.insert(names.end(), {"gyro_x (rad/s)", "gyro_y (rad/s)", "gyro_z (rad/s)"});
  }
  if (holds != Inertial::Gyroscope) {
    names.insert(names.end(), {"acc_x (m/s^2)", "acc_y (m/s^2)", "acc_z (m/s^2)"});
  }
  return names;
}

std::string quoted_name(std::string_view name) {
  std::string shown = "'";
  for (const char c : name.substr(0, kLongestName)) {
    shown += c >= ' ' && c <= '~' ? c : '?';
  }
  return shown + (name.size() > kLongestName ? "...'" : "'");
}

Result<std::size_t> InertialStreams::add(std::string name, Inertial holds, ColumnNames columns) {
  if (streams_.size() == kMostStreams) {
    return fail(ErrorCode::LimitExceeded,
                "The file declares more than " + std::to_string(kMostStreams) + " inertial streams.",
                {{"limit", std::to_string(kMostStreams)}});
  }
  streams_.push_back({std::move(name), holds, std::move(columns), {}});
  return streams_.size() - 1;
}

Status InertialStreams::take(std::size_t stream_index, std::uint64_t stamp, std::span<const double> values) {
  Stream& stream = streams_[stream_index];
  ++samples_;
  stream.first = stream.samples == 0 ? stamp : stream.first;
  ++stream.samples;
  const bool in_table = stream_index == chosen_ || !stream.heading.empty();
  if (stream.full || (chosen_ != kNone && !in_table)) {
    return {};
  }
  // The difference is exact in whole ticks, whatever the epoch, and so the same in formats of other ticks.
  stream.waiting.push_back(static_cast<double>(static_cast<std::int64_t>(stamp - stream.first)) / ticks_per_s_);
  for (const double value : values) {
    stream.waiting.push_back(
        std::isfinite(value) ? value
                             : missing_sample(std::isnan(value) ? Missing::Nan : Missing::Infinite, stream.samples));
  }
  if (chosen_ != kNone) {
    return stream.waiting.size() < kBatch ? Status{} : advance(stream);
  }
  waiting_bytes_ += stream.width() * sizeof(double);
  return waiting_bytes_ < kMostWaitingBytes ? Status{} : choose();
}

/// The stream that the rule takes.
std::size_t InertialStreams::best() const {
  std::size_t chosen = kNone;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const Stream& stream = streams_[i];
    if (stream.samples == 0) {
      continue;
    }
    const bool better = chosen == kNone || stream.holds > streams_[chosen].holds ||
                        (stream.holds == streams_[chosen].holds && stream.samples > streams_[chosen].samples);
    chosen = better ? i : chosen;
  }
  return chosen;
}

Status InertialStreams::choose() {
  chosen_ = best();
  Stream& chosen = streams_[chosen_];
  ColumnLayout layout{{"time (s)"}, true};
  layout.names.insert(layout.names.end(), chosen.columns.begin(), chosen.columns.end());
  std::size_t units = 1;
  for (Stream& stream : streams_) {
    if (&stream == &chosen) {
      continue;
    }
    if (stream.samples == 0 || kMostTimesSlower * stream.samples < chosen.samples || units == kMostInTable) {
      stream.full = true;
      std::vector<double>().swap(stream.waiting);
      continue;
    }
    stream.heading = "imu" + std::to_string(++units);
    stream.column = layout.names.size();
    layout.names.push_back(stream.heading + "_time (s)");
    for (const std::string& column : stream.columns) {
      layout.names.push_back(stream.heading + "_" + column);
    }
  }
  beside_column_ = layout.names.size();
  const ColumnNames beside = beside_.settle();
  layout.names.insert(layout.names.end(), beside.begin(), beside.end());
  alone_ = beside.empty() && units == 1;
  if (auto status = sink_.begin(layout); !status) {
    return status;
  }
  for (Stream& stream : streams_) {
    if (auto status = stream.full ? Status{} : advance(stream); !status) {
      return status;
    }
  }
  return {};
}

/// Delivers what waits: of another stream no row that the chosen one does not have yet.
Status InertialStreams::advance(Stream& stream) {
  const Stream& chosen = streams_[chosen_];
  if (&stream == &chosen) {
    return flush(stream, stream.waiting_rows());
  }
  const std::size_t count = std::min<std::uint64_t>(stream.waiting_rows(), chosen.samples - stream.rows);
  auto status = flush(stream, count);
  stream.full = stream.waiting.size() * sizeof(double) > kMostAheadBytes;
  return status;
}

Status InertialStreams::flush(Stream& stream, std::size_t count) {
  if (count == 0) {
    return {};
  }
  const auto end = stream.waiting.begin() + static_cast<std::ptrdiff_t>(count * stream.width());
  stream.last_s = *(end - static_cast<std::ptrdiff_t>(stream.width()));
  stream.rows += count;
  auto status = alone_ ? flush_rows(stream) : flush_columns(stream, count);
  stream.waiting.erase(stream.waiting.begin(), end);
  if (stream.waiting.capacity() > 2 * kBatch && stream.waiting.empty()) {
    std::vector<double>().swap(stream.waiting);
  }
  return status;
}

/// Whole rows, some thousand numbers at a time.
Status InertialStreams::flush_rows(const Stream& stream) {
  const std::size_t step = kBatch / stream.width() * stream.width();
  std::span<const double> rest(stream.waiting);
  while (!rest.empty()) {
    const std::size_t count = std::min(step, rest.size());
    if (auto status = sink_.rows(rest.first(count)); !status) {
      return status;
    }
    rest = rest.subspan(count);
  }
  return {};
}

/// The first `count` rows that wait, as columns: they are not whole rows of the table.
Status InertialStreams::flush_columns(const Stream& stream, std::size_t count) {
  const std::size_t width = stream.width();
  std::vector<double> column(count);
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t row = 0; row < count; ++row) {
      column[row] = stream.waiting[row * width + i];
    }
    if (auto status = sink_.column(stream.column + i, column); !status) {
      return status;
    }
  }
  return {};
}

/// Fills the columns of another stream up to the rows of the chosen one.
Status InertialStreams::finish_other(Stream& stream) {
  if (auto status = advance(stream); !status) {
    return status;
  }
  const double step_s = stream.rows > 1 ? stream.last_s / static_cast<double>(stream.rows - 1) : 1.0;
  const std::uint64_t rows = streams_[chosen_].samples;
  for (std::uint64_t from = stream.rows; from < rows; from += kBatch) {
    std::vector<double> batch(std::min<std::uint64_t>(kBatch, rows - from));
    for (std::size_t i = 0; i < batch.size(); ++i) {
      batch[i] = stream.last_s + step_s * static_cast<double>(from + i + 1 - stream.rows);
    }
    auto status = sink_.column(stream.column, batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      batch[i] = missing_sample(Missing::Ended, from + i + 1);
    }
    for (std::size_t i = 1; status && i < stream.width(); ++i) {
      status = sink_.column(stream.column + i, batch);
    }
    if (!status) {
      return status;
    }
  }
  return {};
}

/// A table of what would stand beside an inertial stream.
Status InertialStreams::finish_alone() {
  if (auto status = sink_.begin({beside_.settle(), true}); !status) {
    return status;
  }
  return beside_.deliver(sink_, 0, beside_.longest(), beside_.first_stamp(), ticks_per_s_);
}

Status InertialStreams::finish(const std::string& nothing) {
  if (samples_ == 0) {
    return beside_.empty() ? Status(fail(ErrorCode::NoSamples, nothing)) : finish_alone();
  }
  if (auto status = chosen_ == kNone ? choose() : advance(streams_[chosen_]); !status) {
    return status;
  }
  for (Stream& stream : streams_) {
    if (auto status = stream.heading.empty() ? Status{} : finish_other(stream); !status) {
      return status;
    }
  }
  note_others();
  const Stream& chosen = streams_[chosen_];
  return beside_.deliver(sink_, beside_column_, chosen.samples, chosen.first, ticks_per_s_);
}

/// Which of several inertial streams is the recording, and where the others are.
void InertialStreams::note_others() {
  const auto text_of = [](const Stream& stream) {
    return "(" + std::string(contents_of(stream.holds)) + ", " + with_count(stream.samples, "sample") + ")";
  };
  NameList others(kMostNames);
  NameList left_out(kMostNames);
  for (const Stream& stream : streams_) {
    if (!stream.heading.empty()) {
      others.add(stream.heading + " is " + quoted_name(stream.name) + " " + text_of(stream));
    } else if (&stream != &streams_[chosen_] && stream.samples > 0) {
      left_out.add(quoted_name(stream.name) + " " + text_of(stream));
    }
  }
  const Stream& chosen = streams_[chosen_];
  if (!others.empty() || !left_out.empty()) {
    sink_.note("Of several inertial streams " + quoted_name(chosen.name) + " is read " + text_of(chosen) + "." +
               (others.empty() ? "" : " State another one as `stream` to have it read: " + others.text() + ".") +
               (left_out.empty() ? "" : " Left out: " + left_out.text() + "."));
  }
  for (const Stream& stream : streams_) {
    if (!stream.heading.empty() && stream.samples > stream.rows) {
      sink_.note("Of " + quoted_name(stream.name) + " the last " +
                 with_count(stream.samples - stream.rows, "row is left out.", "rows are left out.") +
                 " It is longer than the inertial stream that it stands beside.");
    }
  }
}

}  // namespace driftlab
