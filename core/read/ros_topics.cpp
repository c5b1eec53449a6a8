#include "core/read/ros_topics.hpp"

#include "core/signal/with_count.hpp"

#include <array>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostTopics = 65536;

/// `package/Name` as ROS 1 writes it, or `package/msg/Name`.
bool is_type(std::string_view type, std::string_view package, std::string_view name) {
  if (!type.starts_with(package) || !type.ends_with(name)) {
    return false;
  }
  const std::string_view between = type.substr(package.size(), type.size() - package.size() - name.size());
  return between == "/" || between == "/msg/";
}

}  // namespace

Result<std::size_t> RosTopics::add(std::string_view name, std::string_view type, std::string_view encoding) {
  if (topics_.size() == kMostTopics) {
    return fail(ErrorCode::LimitExceeded, "The file has more than " + std::to_string(kMostTopics) + " topics.",
                {{"limit", std::to_string(kMostTopics)}});
  }
  std::optional<Content> content;
  if (is_type(type, "sensor_msgs", "Imu")) {
    content = Content::Imu;
  } else if (is_type(type, "sensor_msgs", "NavSatFix")) {
    content = Content::Fix;
  } else if (is_type(type, "nav_msgs", "Odometry")) {
    content = Content::Odometry;
  }
  std::optional<RosEncoding> wanted;
  if (content && encoding == "ros1") {
    wanted = RosEncoding::Ros1;
  } else if (content && encoding == "cdr") {
    wanted = RosEncoding::Cdr;
  }
  constexpr std::size_t kKept = 100;  // names are for sentences only
  topics_.push_back({std::string(name.substr(0, kKept)), std::string(type.substr(0, kKept)),
                     content.value_or(Content::Imu), wanted, std::nullopt});
  return topics_.size() - 1;
}

/// False where the message cannot be read.
bool RosTopics::take_imu(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns,
                         Status& status) {
  const auto imu = read_ros_imu(message, encoding);
  if (!imu || (!imu->measures_gyro && !imu->measures_accel)) {
    return false;
  }
  if (!topic.stream) {
    topic.gyro = imu->measures_gyro;
    topic.accel = imu->measures_accel;
    topic.log_time = imu->stamp_ns == 0;
    const Inertial holds = !topic.accel ? Inertial::Gyroscope : topic.gyro ? Inertial::Both : Inertial::Accelerometer;
    auto stream = streams_.add(topic.name, holds, inertial_columns(holds));
    if (!stream) {
      status = fail(stream.error());
      return true;
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
  status = streams_.take(*topic.stream, topic.log_time ? log_ns : imu->stamp_ns, std::span(row).first(width));
  return true;
}

bool RosTopics::take_fix(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns) {
  const auto fix = read_ros_fix(message, encoding);
  if (!fix) {
    return false;
  }
  if (!topic.stream) {
    topic.log_time = fix->stamp_ns == 0;
    topic.stream = streams_.add_beside(
        topic.name, "gnss",
        {"status", "latitude (deg)", "longitude (deg)", "height (m)", "sd_east (m)", "sd_north (m)", "sd_up (m)"});
  }
  const std::array row{static_cast<double>(fix->status),
                       fix->latitude_deg,
                       fix->longitude_deg,
                       fix->height_m,
                       fix->sd_m[0],
                       fix->sd_m[1],
                       fix->sd_m[2]};
  streams_.take_beside(*topic.stream, topic.log_time ? log_ns : fix->stamp_ns, row);
  return true;
}

bool RosTopics::take_odometry(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns) {
  const auto odometry = read_ros_odometry(message, encoding);
  if (!odometry) {
    return false;
  }
  if (!topic.stream) {
    topic.log_time = odometry->stamp_ns == 0;
    topic.stream = streams_.add_beside(
        topic.name, "odometry",
        {"position_x (m)", "position_y (m)", "position_z (m)", "velocity_x (m/s)", "velocity_y (m/s)",
         "velocity_z (m/s)", "rate_x (rad/s)", "rate_y (rad/s)", "rate_z (rad/s)"});
  }
  std::array<double, 9> row{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    row[axis] = odometry->position_m[axis];
    row[3 + axis] = odometry->velocity_m_s[axis];
    row[6 + axis] = odometry->rate_rad_s[axis];
  }
  streams_.take_beside(*topic.stream, topic.log_time ? log_ns : odometry->stamp_ns, row);
  return true;
}

Status RosTopics::take(std::size_t index, std::string_view message, std::uint64_t log_ns) {
  Topic& topic = topics_[index];
  if (!topic.encoding) {
    return {};
  }
  const RosEncoding encoding = *topic.encoding;
  Status status;
  const bool read = topic.content == Content::Imu   ? take_imu(topic, encoding, message, log_ns, status)
                    : topic.content == Content::Fix ? take_fix(topic, encoding, message, log_ns)
                                                    : take_odometry(topic, encoding, message, log_ns);
  unreadable_ += read ? 0 : 1;
  return status;
}

Status RosTopics::finish(const std::string& container) {
  NameList others(kMostNames);
  for (const Topic& topic : topics_) {
    if (!topic.encoding) {
      others.add(quoted_name(topic.name) + " (" + quoted_name(topic.type) + ")");
    }
    if (topic.log_time) {
      sink_.note("The messages of " + quoted_name(topic.name) + " have no stamp; their time is that of the recording.");
    }
  }
  if (unreadable_ > 0) {
    sink_.note(with_count(unreadable_, "message cannot be read and is left out.",
                          "messages cannot be read and are left out."));
  }
  if (!others.empty() && !streams_.empty()) {
    sink_.note("Topics of other types are left out: " + others.text() + ".");
  }
  return streams_.finish("The " + container +
                         " holds no readable message of type sensor_msgs/Imu, sensor_msgs/NavSatFix or "
                         "nav_msgs/Odometry" +
                         (others.empty() ? "." : "; its topics are " + others.text() + "."));
}

}  // namespace driftlab
