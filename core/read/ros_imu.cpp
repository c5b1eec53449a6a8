#include "core/read/ros_imu.hpp"

#include "core/read/little_endian.hpp"
#include "core/signal/with_count.hpp"

#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostTopics = 65536;
// In doubles from the orientation on.
constexpr std::size_t kGyro = 13;
constexpr std::size_t kGyroCovariance = 16;
constexpr std::size_t kAccel = 25;
constexpr std::size_t kAccelCovariance = 28;
constexpr std::size_t kDoubles = 37;

/// Words of either byte order.
struct Words {
  std::string_view bytes;
  bool swap = false;

  [[nodiscard]] std::uint32_t word(std::size_t at) const {
    const auto value = load_at<std::uint32_t>(bytes, at);
    return swap ? __builtin_bswap32(value) : value;
  }
  [[nodiscard]] double number(std::size_t at) const {
    const auto value = load_at<std::uint64_t>(bytes, at);
    return std::bit_cast<double>(swap ? __builtin_bswap64(value) : value);
  }
};

}  // namespace

std::optional<RosImu> read_ros_imu(std::string_view message, RosEncoding encoding) {
  Words words{message};
  std::size_t stamp = 4;  // behind the sequence number
  std::size_t alignment = 1;
  if (encoding == RosEncoding::Cdr) {
    const bool plain = message.size() > 4 && message[0] == '\0' && (message[1] == '\0' || message[1] == '\1');
    if (!plain) {
      return std::nullopt;
    }
    words = {message.substr(4), message[1] == '\0'};
    stamp = 0;
    alignment = 8;
  }
  const std::size_t text = stamp + 12;  // the characters of frame_id
  if (words.bytes.size() < text) {
    return std::nullopt;
  }
  const std::uint64_t end = std::uint64_t{text} + words.word(text - 4);
  const std::uint64_t numbers = (end + alignment - 1) / alignment * alignment;
  if (words.bytes.size() < numbers + kDoubles * sizeof(double)) {
    return std::nullopt;
  }
  const auto at = [&](std::size_t index) { return words.number(numbers + index * sizeof(double)); };
  RosImu imu;
  imu.stamp_ns = std::uint64_t{words.word(stamp)} * 1'000'000'000U + words.word(stamp + 4);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    imu.gyro_rad_s[axis] = at(kGyro + axis);
    imu.accel_m_s2[axis] = at(kAccel + axis);
  }
  imu.measures_gyro = at(kGyroCovariance) != -1.0;
  imu.measures_accel = at(kAccelCovariance) != -1.0;
  return imu;
}

Result<std::size_t> RosTopics::add(std::string_view name, std::string_view type, std::string_view encoding) {
  if (topics_.size() == kMostTopics) {
    return fail(ErrorCode::LimitExceeded, "The file has more than " + std::to_string(kMostTopics) + " topics.",
                {{"limit", std::to_string(kMostTopics)}});
  }
  const bool imu = type == "sensor_msgs/Imu" || type == "sensor_msgs/msg/Imu";
  std::optional<RosEncoding> wanted;
  if (imu && encoding == "ros1") {
    wanted = RosEncoding::Ros1;
  } else if (imu && encoding == "cdr") {
    wanted = RosEncoding::Cdr;
  }
  constexpr std::size_t kKept = 100;  // names are for sentences only
  topics_.push_back({std::string(name.substr(0, kKept)), std::string(type.substr(0, kKept)), wanted, std::nullopt});
  return topics_.size() - 1;
}

Status RosTopics::take(std::size_t index, std::string_view message, std::uint64_t log_ns) {
  Topic& topic = topics_[index];
  const auto imu = topic.encoding ? read_ros_imu(message, *topic.encoding) : std::nullopt;
  if (!imu || (!imu->measures_gyro && !imu->measures_accel)) {
    ++unreadable_;
    return {};
  }
  if (!topic.stream) {
    topic.gyro = imu->measures_gyro;
    topic.accel = imu->measures_accel;
    topic.log_time = imu->stamp_ns == 0;
    const Inertial holds = !topic.accel ? Inertial::Gyroscope : topic.gyro ? Inertial::Both : Inertial::Accelerometer;
    auto stream = streams_.add(topic.name, holds, inertial_columns(holds));
    if (!stream) {
      return fail(stream.error());
    }
    topic.stream = *stream;
  }
  std::array<double, 6> row{};
  std::size_t width = 0;
  for (std::size_t axis = 0; topic.gyro && axis < 3; ++axis) {
    row[width++] = imu->gyro_rad_s[axis];
  }
  for (std::size_t axis = 0; topic.accel && axis < 3; ++axis) {
    row[width++] = imu->accel_m_s2[axis];
  }
  return streams_.take(*topic.stream, topic.log_time ? log_ns : imu->stamp_ns, std::span(row).first(width));
}

Status RosTopics::finish(const std::string& container) {
  NameList others;
  for (const Topic& topic : topics_) {
    if (!topic.encoding) {
      others.add(quoted_name(topic.name) + " (" + quoted_name(topic.type) + ")");
    }
    if (topic.log_time) {
      sink_.note("The messages of " + quoted_name(topic.name) + " have no stamp; their time is that of the recording.");
    }
  }
  if (unreadable_ > 0) {
    sink_.note(with_count(unreadable_, "inertial message cannot be read and is left out.",
                          "inertial messages cannot be read and are left out."));
  }
  if (!others.empty() && !streams_.empty()) {
    sink_.note("Topics of other types are left out: " + others.text() + ".");
  }
  return streams_.finish("The " + container + " holds no readable message of type sensor_msgs/Imu" +
                         (others.empty() ? "." : "; its topics are " + others.text() + "."));
}

}  // namespace driftlab
