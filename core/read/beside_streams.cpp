#include "core/read/beside_streams.hpp"

#include "core/read/inertial_streams.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kMostStreams = 16;
constexpr std::size_t kBatch = 8192;

/// `value(row)` for the rows that there are, then places without a sample up to `rows`.
template <class Value>
Status fill_column(ColumnSink& sink, std::size_t column, std::size_t there, std::size_t rows, Value value) {
  std::vector<double> batch;
  for (std::size_t row = 0; row < rows; ++row) {
    batch.push_back(row < there ? value(row) : missing_sample(Missing::Ended, row + 1));
    if (batch.size() == kBatch || row + 1 == rows) {
      if (auto status = sink.column(column, batch); !status) {
        return status;
      }
      batch.clear();
    }
  }
  return {};
}

}  // namespace

std::size_t BesideStreams::add(std::string name, std::string kind, ColumnNames columns) {
  streams_.push_back({std::move(name), std::move(kind), std::move(columns), {}, {}, {}});
  return streams_.size() - 1;
}

void BesideStreams::take(std::size_t index, std::uint64_t stamp, std::span<const double> values) {
  Stream& stream = streams_[index];
  const std::size_t bytes = (values.size() + 1) * sizeof(double);
  if ((settled_ && !stream.in_table()) || bytes_ + bytes > kMostBytes) {
    ++stream.left_out;
    return;
  }
  bytes_ += bytes;
  stream.stamps.push_back(stamp);
  for (const double value : values) {
    stream.values.push_back(std::isfinite(value) ? value
                                                 : missing_sample(std::isnan(value) ? Missing::Nan : Missing::Infinite,
                                                                  stream.stamps.size()));
  }
}

bool BesideStreams::empty() const {
  return std::all_of(streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.stamps.empty(); });
}

ColumnNames BesideStreams::settle() {
  settled_ = true;
  std::size_t count = 0;
  ColumnNames names;
  for (auto stream = streams_.begin(); stream != streams_.end(); ++stream) {
    if (stream->stamps.empty() || count == kMostStreams) {
      stream->left_out += stream->stamps.size();
      continue;
    }
    ++count;
    const auto before = std::count_if(
        streams_.begin(), stream, [&](const Stream& other) { return other.in_table() && other.kind == stream->kind; });
    stream->heading = stream->kind + (before == 0 ? "" : std::to_string(before + 1)) + "_";
    names.push_back(stream->heading + "time (s)");
    for (const std::string& column : stream->columns) {
      names.push_back(stream->heading + column);
    }
  }
  return names;
}

std::uint64_t BesideStreams::first_stamp() const {
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
  for (const Stream& stream : streams_) {
    first = stream.in_table() ? std::min(first, stream.stamps.front()) : first;
  }
  return first;
}

std::size_t BesideStreams::longest() const {
  std::size_t rows = 0;
  for (const Stream& stream : streams_) {
    rows = stream.in_table() ? std::max(rows, stream.stamps.size()) : rows;
  }
  return rows;
}

Status BesideStreams::deliver_one(ColumnSink& sink, const Stream& stream, std::size_t column, std::size_t rows,
                                  std::uint64_t origin, double ticks_per_s) const {
  const std::size_t there = std::min(stream.stamps.size(), rows);
  // The difference is exact in whole ticks, whatever the epoch.
  auto status = fill_column(sink, column, there, rows, [&](std::size_t row) {
    return static_cast<double>(static_cast<std::int64_t>(stream.stamps[row] - origin)) / ticks_per_s;
  });
  const std::size_t width = stream.columns.size();
  for (std::size_t i = 0; status && i < width; ++i) {
    status =
        fill_column(sink, column + 1 + i, there, rows, [&](std::size_t row) { return stream.values[row * width + i]; });
  }
  return status;
}

Status BesideStreams::deliver(ColumnSink& sink, std::size_t column, std::size_t rows, std::uint64_t origin,
                              double ticks_per_s) const {
  NameList named(kMostNames);
  for (const Stream& stream : streams_) {
    if (stream.in_table()) {
      named.add(quoted_name(stream.name) + " (" + stream.heading + ", " + with_count(stream.stamps.size(), "row") +
                ")");
    }
  }
  if (!named.empty()) {
    sink.note("In columns of their own, on clocks of their own, stand " + named.text() + ".");
  }
  for (const Stream& stream : streams_) {
    const std::uint64_t cut = stream.in_table() && stream.stamps.size() > rows ? stream.stamps.size() - rows : 0;
    if (cut + stream.left_out > 0) {
      sink.note("Of " + quoted_name(stream.name) + " the last " +
                with_count(cut + stream.left_out, "row is left out.", "rows are left out.") +
                (cut > 0 ? " It is longer than the inertial stream that it stands beside." : ""));
    }
    if (!stream.in_table()) {
      continue;
    }
    if (auto status = deliver_one(sink, stream, column, rows, origin, ticks_per_s); !status) {
      return status;
    }
    column += stream.columns.size() + 1;
  }
  return {};
}

}  // namespace driftlab
