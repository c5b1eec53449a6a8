#include "core/read/decode_head.hpp"

#include "core/read/recognised_stream.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostRows = 20000;
constexpr std::size_t kMostSamples = 2'000'000;

/// Keeps the first samples, then asks the decoder to stop.
class HeadSink final : public ColumnSink {
 public:
  explicit HeadSink(DecodedHead& head, const DecodeLimits& limits) : head_(head), limits_(limits) {}

  Status begin(const ColumnLayout& layout) override {
    auto sound = sound_layout(layout);
    if (!sound) {
      return fail(sound.error());
    }
    head_.names = std::move(sound->names);
    head_.has_header = layout.has_header;
    head_.columns.resize(layout.names.size());
    most_rows_ = std::min(kMostRows, std::max<std::size_t>(1, kMostSamples / layout.names.size()));
    return {};
  }
  Status rows(std::span<const double> values) override {
    const std::size_t width = head_.columns.size();
    const std::size_t count = std::min(values.size() / width, most_rows_ - head_.columns.front().size());
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t i = 0; i < width; ++i) {
        head_.columns[i].push_back(values[row * width + i]);
      }
    }
    return go_on();
  }
  Status column(std::size_t index, std::span<const double> values) override {
    std::vector<double>& column = head_.columns[index];
    const auto first = values.first(std::min(values.size(), most_rows_ - column.size()));
    column.insert(column.end(), first.begin(), first.end());
    return go_on();
  }
  void note(std::string sentence) override {
    if (head_.notes.size() < limits_.max_notes) {
      head_.notes.push_back(sound_note(sentence, limits_));
    }
  }
  [[nodiscard]] bool full() const { return full_; }

 private:
  Status go_on() {
    full_ = head_.rows() == most_rows_;
    return full_ ? Status(fail(ErrorCode::Cancelled, "There are samples enough.")) : Status{};
  }

  DecodedHead& head_;
  const DecodeLimits& limits_;
  std::size_t most_rows_ = 0;
  bool full_ = false;
};

/// What only says that the rest of the file is not there.
bool says_more_is_to_come(ErrorCode code) {
  return code == ErrorCode::Truncated || code == ErrorCode::CorruptCompression || code == ErrorCode::ShapeMismatch ||
         code == ErrorCode::NoSamples || code == ErrorCode::ParseError;
}

/// Plain text without the line that the end of the piece tore.
std::string_view whole_lines(std::string_view bytes) {
  const bool text = sniff_compression(bytes) == Compression::None && bytes.find('\0') == std::string_view::npos;
  const std::size_t end = bytes.rfind('\n');
  return text && end != std::string_view::npos ? bytes.substr(0, end + 1) : bytes;
}

}  // namespace

std::size_t DecodedHead::rows() const {
  std::size_t least = columns.empty() ? 0 : columns.front().size();
  for (const std::vector<double>& column : columns) {
    least = std::min(least, column.size());
  }
  return least;
}

Result<DecodedHead> decode_head(std::string_view bytes, HeadExtent extent, const DecodeLimits& limits) {
  const bool beginning = extent == HeadExtent::Beginning;
  auto stream = recognise_stream(make_memory_reader(beginning ? whole_lines(bytes) : bytes), limits,
                                 beginning ? StreamEnd::Anywhere : StreamEnd::OfTheFile);
  if (!stream) {
    return fail(stream.error());
  }
  DecodedHead head;
  head.format = stream->format->name;
  head.compression = stream->compression;
  HeadSink sink(head, limits);
  const auto decoded = stream->format->decode(stream->source, limits, sink, RunControl{});
  if (!decoded && !sink.full() && !(beginning && says_more_is_to_come(decoded.error().code))) {
    return fail(sound_error(decoded.error()));
  }
  return head;
}

}  // namespace driftlab
