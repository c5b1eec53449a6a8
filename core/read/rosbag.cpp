/// ROS 1 bag, version 2.0: a line of text, then records of a header (named fields) and data, most of them in chunks.
/// Connections name a topic and its type; messages about a journey are read (core/read/ros_topics.hpp). Chunks are
/// plain, bzip2 or LZ4. Source: ROS wiki, "Bags/Format/2.0".
#include "core/read/formats.hpp"
#include "core/read/little_endian.hpp"
#include "core/read/packed_chunk.hpp"
#include "core/read/ros_topics.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kAnyVersion = "#ROSBAG V"sv;
constexpr std::string_view kMagic = "#ROSBAG V2.0\n"sv;
constexpr std::size_t kMostHeaderBytes = std::size_t{64} * 1024;
constexpr std::size_t kMostConnectionBytes = std::size_t{4} << 20;
enum class Level { File, Chunk };
enum Operation : unsigned char { Message = 2, BagHeader = 3, Chunk = 5, Connection = 7 };

/// The value of a field, `name=value` behind its length; nothing where it is not there.
std::optional<std::string_view> find_field(std::string_view fields, std::string_view name) {
  while (fields.size() >= 4) {
    const std::size_t size = load_at<std::uint32_t>(fields, 0);
    if (size > fields.size() - 4) {
      return std::nullopt;
    }
    const std::string_view field = fields.substr(4, size);
    if (field.size() > name.size() && field[name.size()] == '=' && field.starts_with(name)) {
      return field.substr(name.size() + 1);
    }
    fields.remove_prefix(4 + size);
  }
  return std::nullopt;
}

template <class Number>
std::optional<Number> find_number(std::string_view fields, std::string_view name) {
  const auto value = find_field(fields, name);
  return value && value->size() == sizeof(Number) ? std::optional(load_at<Number>(*value, 0)) : std::nullopt;
}

/// The header of a record, by value: the bytes it was in are gone when the data are looked at.
struct Header {
  unsigned char operation = 0;
  std::uint32_t connection = 0;
  std::uint64_t time_ns = 0;
  std::string topic;
  std::string compression;
  std::uint64_t index_position = 0;
  std::uint32_t data_bytes = 0;
};

class BagDecoder {
 public:
  BagDecoder(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control)
      : source_(source),
        sink_(sink),
        control_(control),
        topics_(sink),
        budget_(limits.expanded_budget(source.input_size())) {}

  Status run();

 private:
  Result<bool> walk(ByteSource& records, Level level);
  Result<std::optional<Header>> take_header(ByteSource& records);
  Result<bool> take_data(ByteSource& records, const Header& header, Level level);
  Result<bool> take_connection(ByteSource& records, const Header& header);
  [[nodiscard]] tl::unexpected<Error> contradiction(const std::string& what) const {
    return fail(ErrorCode::ShapeMismatch,
                "The ROS bag contradicts itself at byte " + std::to_string(source_.offset()) + ": " + what + ".");
  }

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  RosTopics topics_;
  ExpansionBudget budget_;
  std::map<std::uint32_t, std::size_t> connections_;  ///< topic by number
  bool closed_ = false;
};

/// Nothing where `records` ends within the header.
Result<std::optional<Header>> BagDecoder::take_header(ByteSource& records) {
  auto view = records.view(4);
  if (!view) {
    return fail(view.error());
  }
  const std::size_t size = view->size() < 4 ? 0 : load_at<std::uint32_t>(*view, 0);
  if (size > kMostHeaderBytes) {
    return contradiction("a header of " + std::to_string(size) + " bytes");
  }
  view = records.view(size + 8);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < size + 8) {
    records.consume(view->size());
    return std::optional<Header>();
  }
  const std::string_view fields = view->substr(4, size);
  const auto operation = find_number<unsigned char>(fields, "op");
  if (!operation) {
    return contradiction("a record does not say what it is");
  }
  Header header;
  header.operation = *operation;
  header.connection = find_number<std::uint32_t>(fields, "conn").value_or(0);
  const std::uint64_t time = find_number<std::uint64_t>(fields, "time").value_or(0);
  header.time_ns = (time & 0xFFFFFFFFU) * 1'000'000'000U + (time >> 32U);
  header.topic = find_field(fields, "topic").value_or("");
  header.compression = find_field(fields, "compression").value_or("");
  header.index_position = find_number<std::uint64_t>(fields, "index_pos").value_or(0);
  header.data_bytes = load_at<std::uint32_t>(*view, 4 + size);
  records.consume(size + 8);
  return std::optional(std::move(header));
}

/// Takes records until `records` ends. False where it ends within one.
Result<bool> BagDecoder::walk(ByteSource& records, Level level) {
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto next = records.view();
    if (!next) {
      return fail(next.error());
    }
    if (next->empty()) {
      return true;
    }
    auto taken = take_header(records);
    if (!taken) {
      return fail(taken.error());
    }
    const auto& header = *taken;
    if (!header) {
      return false;
    }
    auto whole = take_data(records, *header, level);
    if (!whole || !*whole) {
      return whole;
    }
  }
}

Result<bool> BagDecoder::take_data(ByteSource& records, const Header& header, Level level) {
  if (header.operation == Chunk && level == Level::File) {
    const auto packing = packing_of(header.compression);
    if (!packing) {
      return fail(ErrorCode::UnsupportedType, "The ROS bag has chunks compressed by " +
                                                  quoted_name(header.compression) + "; none, bz2 and lz4 are read.");
    }
    return read_chunk(records, header.data_bytes, {*packing}, budget_, control_,
                      [this](ByteSource& content) { return walk(content, Level::Chunk); });
  }
  if (header.operation == Connection) {
    return take_connection(records, header);
  }
  closed_ = closed_ || (header.operation == BagHeader && header.index_position > 0);
  const auto topic = header.operation == Message ? connections_.find(header.connection) : connections_.end();
  if (topic == connections_.end() || !topics_.wants(topic->second) || header.data_bytes > RosTopics::kLongestMessage ||
      header.data_bytes == 0) {
    auto skipped = skip_bytes(records, header.data_bytes, control_);
    return skipped ? Result<bool>(*skipped == header.data_bytes) : fail(skipped.error());
  }
  auto view = records.view(header.data_bytes);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < header.data_bytes) {
    records.consume(view->size());
    return false;
  }
  if (auto status = topics_.take(topic->second, view->substr(0, header.data_bytes), header.time_ns); !status) {
    return fail(status.error());
  }
  records.consume(header.data_bytes);
  return true;
}

Result<bool> BagDecoder::take_connection(ByteSource& records, const Header& header) {
  if (header.data_bytes > kMostConnectionBytes) {
    return contradiction("a connection of " + std::to_string(header.data_bytes) + " bytes");
  }
  auto view = records.view(std::max<std::size_t>(header.data_bytes, 1));
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < header.data_bytes) {
    records.consume(view->size());
    return false;
  }
  if (!connections_.contains(header.connection)) {  // the index at the end repeats the connections
    const std::string_view data = view->substr(0, header.data_bytes);
    auto topic = topics_.add(header.topic, find_field(data, "type").value_or("no type"), "ros1");
    if (!topic) {
      return fail(topic.error());
    }
    connections_.emplace(header.connection, *topic);
  }
  records.consume(header.data_bytes);
  return true;
}

Status BagDecoder::run() {
  auto magic = source_.view(kMagic.size());
  if (!magic) {
    return fail(magic.error());
  }
  if (!magic->starts_with(kMagic)) {
    return fail(ErrorCode::UnsupportedType,
                "This is a ROS bag of another version than 2.0; `rosbag fix` of ROS 1 brings it up to date.");
  }
  source_.consume(kMagic.size());
  auto whole = walk(source_, Level::File);
  if (!whole) {
    return fail(whole.error());
  }
  if (!*whole && topics_.empty()) {
    return fail(ErrorCode::Truncated, "The ROS bag ends within a record at byte " + std::to_string(source_.offset()) +
                                          ", before any message that is read.");
  }
  if (!*whole || !closed_) {
    sink_.note("The bag was not closed: it ends at byte " + std::to_string(source_.offset()) +
               (*whole ? "" : ", within a record") + "; what is before that is read.");
  }
  return topics_.finish("ROS bag");
}

int sniff(std::string_view head) { return head.starts_with(kAnyVersion) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  return BagDecoder(source, limits, sink, control).run();
}

}  // namespace

const Format kRosbag{"rosbag", "ROS 1 bag", sniff, decode};

}  // namespace driftlab::formats
