/// MCAP: a magic number, then records of a letter, a length and a body, some of them in chunks. Channels name a topic,
/// a schema its type; messages of ROS 1 and ROS 2 about a journey are read (core/read/ros_topics.hpp). Chunks are
/// plain, zstd or LZ4; their checksums are verified. Source: "MCAP Format Specification", mcap.dev.
#include "core/read/formats.hpp"
#include "core/read/little_endian.hpp"
#include "core/read/packed_chunk.hpp"
#include "core/read/ros_topics.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "\x89MCAP0\r\n"sv;
constexpr std::size_t kHead = 9;                            ///< letter and length of a record
constexpr std::size_t kMostNamed = std::size_t{64} * 1024;  ///< of a schema or channel, that holds its names
enum class Level { File, Chunk };
enum Record : unsigned char { Footer = 2, Schema = 3, Channel = 4, Message = 5, Chunk = 6 };

/// Takes words and texts off the front of a body.
class Body {
 public:
  explicit Body(std::string_view bytes) : rest_(bytes) {}
  template <class Number>
  std::optional<Number> number() {
    if (rest_.size() < sizeof(Number)) {
      return std::nullopt;
    }
    const auto value = load_at<Number>(rest_, 0);
    rest_.remove_prefix(sizeof(Number));
    return value;
  }
  std::optional<std::string_view> text() {
    const auto size = number<std::uint32_t>();
    if (!size || rest_.size() < *size) {
      return std::nullopt;
    }
    const std::string_view value = rest_.substr(0, *size);
    rest_.remove_prefix(*size);
    return value;
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

class McapDecoder {
 public:
  McapDecoder(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control)
      : source_(source),
        sink_(sink),
        control_(control),
        topics_(sink),
        budget_(limits.expanded_budget(source.input_size())) {}

  Status run();

 private:
  Result<bool> walk(ByteSource& records, Level level);
  Result<bool> take_record(ByteSource& records, unsigned char letter, std::uint64_t size, Level level);
  Status take_names(unsigned char letter, std::string_view body);
  Result<bool> take_message(ByteSource& records, std::uint64_t size);
  Result<bool> take_chunk(std::uint64_t size);
  [[nodiscard]] tl::unexpected<Error> contradiction(const std::string& what) const {
    return fail(ErrorCode::ShapeMismatch,
                "The MCAP file contradicts itself at byte " + std::to_string(source_.offset()) + ": " + what + ".");
  }

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  RosTopics topics_;
  ExpansionBudget budget_;
  std::map<std::uint16_t, std::string> schemas_;   ///< type by number
  std::map<std::uint16_t, std::size_t> channels_;  ///< topic by number
  bool closed_ = false;
};

/// Takes records until `records` ends. False where it ends within one.
Result<bool> McapDecoder::walk(ByteSource& records, Level level) {
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto head = records.view(kHead);
    if (!head) {
      return fail(head.error());
    }
    if (head->size() < kHead) {
      const bool clean = head->empty();
      records.consume(head->size());
      return clean;
    }
    auto whole = take_record(records, static_cast<unsigned char>((*head)[0]), load_at<std::uint64_t>(*head, 1), level);
    if (!whole || !*whole) {
      return whole;
    }
  }
}

Result<bool> McapDecoder::take_record(ByteSource& records, unsigned char letter, std::uint64_t size, Level level) {
  if (letter == Message) {
    return take_message(records, size);
  }
  if (letter == Chunk && level == Level::File) {
    return take_chunk(size);
  }
  if (letter == Schema || letter == Channel) {
    const std::size_t seen = std::min<std::uint64_t>(size, kMostNamed);
    auto body = records.view(kHead + seen);
    if (!body) {
      return fail(body.error());
    }
    if (body->size() >= kHead + seen) {
      if (auto status = take_names(letter, body->substr(kHead, seen)); !status) {
        return fail(status.error());
      }
    }
  }
  closed_ = closed_ || (letter == Footer && level == Level::File);
  // What follows the footer is the magic number again.
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t wanted = closed_ || size > most - kHead ? most : size + kHead;
  auto skipped = skip_bytes(records, wanted, control_);
  return skipped ? Result<bool>(closed_ || *skipped == wanted) : fail(skipped.error());
}

Status McapDecoder::take_names(unsigned char letter, std::string_view bytes) {
  Body body(bytes);
  const auto id = body.number<std::uint16_t>();
  if (letter == Schema) {
    const auto name = body.text();
    if (!id || !name) {
      return contradiction("a schema has no name");
    }
    schemas_.insert_or_assign(*id, std::string(name->substr(0, 100)));
    return {};
  }
  const auto schema = body.number<std::uint16_t>();
  const auto topic = body.text();
  const auto encoding = body.text();
  if (!id || !schema || !topic || !encoding) {
    return contradiction("a channel has no topic");
  }
  if (channels_.contains(*id)) {
    return {};  // the summary at the end repeats the channels
  }
  const auto type = schemas_.find(*schema);
  auto added = topics_.add(*topic, type == schemas_.end() ? "no schema" : std::string_view(type->second), *encoding);
  if (!added) {
    return fail(added.error());
  }
  channels_.emplace(*id, *added);
  return {};
}

Result<bool> McapDecoder::take_message(ByteSource& records, std::uint64_t size) {
  constexpr std::size_t kFront = 22;  // channel, sequence number, time of recording, time of publication
  if (size < kFront) {
    return contradiction("a message has " + std::to_string(size) + " bytes");
  }
  auto view = records.view(kHead + kFront);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < kHead + kFront) {
    records.consume(view->size());
    return false;
  }
  const auto channel = channels_.find(load_at<std::uint16_t>(*view, kHead));
  if (channel == channels_.end() || !topics_.wants(channel->second) || size > RosTopics::kLongestMessage) {
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    const std::uint64_t wanted = size > most - kHead ? most : size + kHead;
    auto skipped = skip_bytes(records, wanted, control_);
    return skipped ? Result<bool>(*skipped == wanted) : fail(skipped.error());
  }
  const std::size_t whole = kHead + static_cast<std::size_t>(size);
  view = records.view(whole);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < whole) {
    records.consume(view->size());
    return false;
  }
  const auto log_ns = load_at<std::uint64_t>(*view, kHead + 6);
  auto status = topics_.take(channel->second, view->substr(kHead + kFront, whole - kHead - kFront), log_ns);
  if (!status) {
    return fail(status.error());
  }
  records.consume(whole);
  return true;
}

Result<bool> McapDecoder::take_chunk(std::uint64_t size) {
  constexpr std::size_t kFront = 8 + 8 + 8 + 4;  // first and last time, unpacked size, checksum
  constexpr std::size_t kLongestFront = kFront + 4 + 16 + 8;
  const std::size_t seen = std::min<std::uint64_t>(size, kLongestFront);
  auto view = source_.view(kHead + seen);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < kHead + seen) {
    source_.consume(view->size());
    return false;
  }
  Body body(view->substr(kHead, seen));
  for (int i = 0; i < 3; ++i) {
    static_cast<void>(body.number<std::uint64_t>());
  }
  const auto checksum = body.number<std::uint32_t>();
  const auto name = body.text();
  const auto length = body.number<std::uint64_t>();
  if (!checksum || !name || !length || *length != size - (seen - body.left())) {
    return contradiction("a chunk's lengths do not agree");
  }
  const auto packing = packing_of(*name);
  if (!packing) {
    return fail(ErrorCode::UnsupportedType,
                "The MCAP file has chunks compressed by " + quoted_name(*name) + "; none, lz4 and zstd are read.");
  }
  const ChunkKind kind{*packing, *checksum == 0 ? std::nullopt : checksum};
  source_.consume(kHead + seen - body.left());
  return read_chunk(source_, *length, kind, budget_, control_,
                    [this](ByteSource& content) { return walk(content, Level::Chunk); });
}

Status McapDecoder::run() {
  source_.consume(kMagic.size());
  auto whole = walk(source_, Level::File);
  if (!whole) {
    return fail(whole.error());
  }
  if (!closed_) {
    const std::string at = std::to_string(source_.offset());
    if (topics_.empty()) {
      return fail(ErrorCode::Truncated, "The MCAP file ends at byte " + at + ", before any message that is read.");
    }
    sink_.note("The file was not closed: it ends at byte " + at + (*whole ? "" : ", within a record") +
               "; what is before that is read.");
  }
  return topics_.finish("MCAP file");
}

int sniff(std::string_view head) { return head.starts_with(kMagic) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  return McapDecoder(source, limits, sink, control).run();
}

}  // namespace

const Format kMcap{"mcap", "MCAP file of ROS 1 or ROS 2 messages", sniff, decode};

}  // namespace driftlab::formats
