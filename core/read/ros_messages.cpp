#include "core/read/ros_messages.hpp"

#include "core/read/little_endian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace driftlab {
namespace {

/// Takes the fields of a message one after the other. CDR aligns a number to its own size, ROS 1 aligns nothing. Fields
/// behind the end are zero, and the message is not whole.
class Fields {
 public:
  Fields(std::string_view message, RosEncoding encoding) : bytes_(message) {
    if (encoding == RosEncoding::Ros1) {
      static_cast<void>(take<std::uint32_t>());  // the number of the message
      return;
    }
    whole_ = message.size() > 4 && message[0] == '\0' && (message[1] == '\0' || message[1] == '\1');
    if (whole_) {
      bytes_.remove_prefix(4);
      aligned_ = true;
      swap_ = message[1] == '\0';
    }
  }

  [[nodiscard]] bool whole() const { return whole_; }

  template <class Number>
  Number take() {
    at_ = aligned_ ? (at_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number) : at_;
    if (!whole_ || bytes_.size() < at_ + sizeof(Number)) {
      whole_ = false;
      return {};
    }
    auto value = load_at<std::array<unsigned char, sizeof(Number)>>(bytes_, at_);
    at_ += sizeof(Number);
    if (swap_) {
      std::reverse(value.begin(), value.end());
    }
    return std::bit_cast<Number>(value);
  }
  template <std::size_t Count>
  std::array<double, Count> numbers() {
    std::array<double, Count> values{};
    if (const std::size_t from = at_of_numbers(Count); whole_) {
      std::memcpy(values.data(), bytes_.data() + from, sizeof values);
    }
    for (double& value : values) {
      value = swap_ ? std::bit_cast<double>(__builtin_bswap64(std::bit_cast<std::uint64_t>(value))) : value;
    }
    return values;
  }
  void skip_numbers(std::size_t count) { static_cast<void>(at_of_numbers(count)); }
  void skip_text() {
    const std::uint64_t size = take<std::uint32_t>();
    whole_ = whole_ && size <= bytes_.size() - at_;
    at_ += whole_ ? size : 0;
  }
  /// std_msgs/Header: its stamp; the frame is left out.
  std::uint64_t stamp_ns() {
    const std::uint64_t seconds = take<std::uint32_t>();
    const std::uint64_t nanoseconds = take<std::uint32_t>();
    skip_text();
    return seconds * 1'000'000'000U + nanoseconds;
  }

 private:
  /// Where that many doubles begin, and on behind them.
  std::size_t at_of_numbers(std::size_t count) {
    const std::size_t from = aligned_ ? (at_ + sizeof(double) - 1) / sizeof(double) * sizeof(double) : at_;
    at_ = from + count * sizeof(double);
    whole_ = whole_ && at_ <= bytes_.size();
    return from;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool aligned_ = false;
  bool swap_ = false;
  bool whole_ = true;
};

}  // namespace

std::optional<RosImu> read_ros_imu(std::string_view message, RosEncoding encoding) {
  Fields fields(message, encoding);
  RosImu imu;
  imu.stamp_ns = fields.stamp_ns();
  fields.skip_numbers(4 + 9);  // the orientation
  imu.gyro_rad_s = fields.numbers<3>();
  imu.measures_gyro = fields.take<double>() != -1.0;
  fields.skip_numbers(8);
  imu.accel_m_s2 = fields.numbers<3>();
  imu.measures_accel = fields.take<double>() != -1.0;
  fields.skip_numbers(8);
  return fields.whole() ? std::optional(imu) : std::nullopt;
}

std::optional<RosFix> read_ros_fix(std::string_view message, RosEncoding encoding) {
  Fields fields(message, encoding);
  RosFix fix;
  fix.stamp_ns = fields.stamp_ns();
  const int status = fields.take<std::uint8_t>();
  fix.status = status < 128 ? status : status - 256;
  static_cast<void>(fields.take<std::uint16_t>());  // the satellite systems
  fix.latitude_deg = fields.take<double>();
  fix.longitude_deg = fields.take<double>();
  fix.height_m = fields.take<double>();
  const std::array<double, 9> covariance = fields.numbers<9>();
  const bool stated = fields.take<std::uint8_t>() != 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double variance = covariance[4 * axis];
    fix.sd_m[axis] = stated && variance > 0.0 ? std::sqrt(variance) : std::numeric_limits<double>::quiet_NaN();
  }
  return fields.whole() ? std::optional(fix) : std::nullopt;
}

std::optional<RosOdometry> read_ros_odometry(std::string_view message, RosEncoding encoding) {
  Fields fields(message, encoding);
  RosOdometry odometry;
  odometry.stamp_ns = fields.stamp_ns();
  fields.skip_text();  // the frame of the robot
  odometry.position_m = fields.numbers<3>();
  fields.skip_numbers(4 + 36);  // orientation and the covariance of the pose
  odometry.velocity_m_s = fields.numbers<3>();
  odometry.rate_rad_s = fields.numbers<3>();
  fields.skip_numbers(36);
  return fields.whole() ? std::optional(odometry) : std::nullopt;
}

}  // namespace driftlab
