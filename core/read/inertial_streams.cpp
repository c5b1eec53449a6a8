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
constexpr std::size_t kBatch = 8192;
constexpr std::size_t kLongestName = 80;
constexpr std::size_t kMostNames = 12;

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

void NameList::add(const std::string& entry) {
  ++count_;
  if (shown_ < kMostNames) {
    ++shown_;
    text_ += (text_.empty() ? "" : ", ") + entry;
  }
}

std::string NameList::text() const {
  return count_ == shown_ ? text_ : text_ + " and " + std::to_string(count_ - shown_) + " more";
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
  if (chosen_ != kNone && stream_index != chosen_) {
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
    return stream.waiting.size() < kBatch ? Status{} : flush(stream);
  }
  waiting_bytes_ += (values.size() + 1) * sizeof(double);
  return waiting_bytes_ < kMostWaitingBytes ? Status{} : choose();
}

Status InertialStreams::choose() {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const Stream& stream = streams_[i];
    if (stream.samples == 0) {
      continue;
    }
    const bool better = chosen_ == kNone || stream.holds > streams_[chosen_].holds ||
                        (stream.holds == streams_[chosen_].holds && stream.samples > streams_[chosen_].samples);
    chosen_ = better ? i : chosen_;
  }
  Stream& chosen = streams_[chosen_];
  for (Stream& stream : streams_) {
    if (&stream != &chosen) {
      std::vector<double>().swap(stream.waiting);
    }
  }
  ColumnLayout layout{{"time (s)"}, true};
  layout.names.insert(layout.names.end(), chosen.columns.begin(), chosen.columns.end());
  const ColumnNames beside = beside_.settle();
  layout.names.insert(layout.names.end(), beside.begin(), beside.end());
  alone_ = beside.empty();
  if (auto status = sink_.begin(layout); !status) {
    return status;
  }
  return flush(chosen);
}

Status InertialStreams::flush(Stream& stream) {
  auto status = alone_ ? flush_rows(stream) : flush_columns(stream);
  if (stream.waiting.capacity() > 2 * kBatch) {
    std::vector<double>().swap(stream.waiting);
  }
  stream.waiting.clear();
  return status;
}

/// Whole rows, some thousand numbers at a time.
Status InertialStreams::flush_rows(const Stream& stream) {
  const std::size_t width = stream.columns.size() + 1;
  const std::size_t step = kBatch / width * width;
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

/// The columns of the chosen stream, whose rows are not whole rows of the table.
Status InertialStreams::flush_columns(const Stream& stream) {
  const std::size_t width = stream.columns.size() + 1;
  std::vector<double> column(stream.waiting.size() / width);
  for (std::size_t i = 0; i < width && !column.empty(); ++i) {
    for (std::size_t row = 0; row < column.size(); ++row) {
      column[row] = stream.waiting[row * width + i];
    }
    if (auto status = sink_.column(i, column); !status) {
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
  auto status = chosen_ == kNone ? choose() : flush(streams_[chosen_]);
  if (status) {
    const Stream& chosen = streams_[chosen_];
    status = beside_.deliver(sink_, chosen.columns.size() + 1, chosen.samples, chosen.first, ticks_per_s_);
  }
  NameList others;
  for (const Stream& stream : streams_) {
    if (&stream != &streams_[chosen_] && stream.samples > 0) {
      others.add(quoted_name(stream.name) + " (" + std::string(contents_of(stream.holds)) + ", " +
                 with_count(stream.samples, "sample") + ")");
    }
  }
  if (!others.empty()) {
    const Stream& chosen = streams_[chosen_];
    sink_.note("Of several inertial streams " + quoted_name(chosen.name) + " is read (" +
               std::string(contents_of(chosen.holds)) + ", " + with_count(chosen.samples, "sample") +
               "); left out: " + others.text() + ".");
  }
  return status;
}

}  // namespace driftlab
