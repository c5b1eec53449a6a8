#pragma once
/// The inertial messages of ROS, whatever file holds them: ROS 1 bags, ROS 2 bags and MCAP. Internal to core/read.
///
/// sensor_msgs/Imu has a stamp, an orientation, an angular rate [rad/s], an acceleration [m/s^2] that includes gravity,
/// and a covariance behind each, whose first element is -1 where the sensor does not measure that quantity. Sources:
/// ROS wiki, "sensor_msgs/Imu" and "Serialization"; OMG DDS-XTypes 1.3, section 7.4 (CDR, encapsulation).
///
/// Time is that of the header's stamp; where the first message of a topic has none, that of the recording, with a note.
#include "core/read/inertial_streams.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

enum class RosEncoding { Ros1, Cdr };

struct RosImu {
  std::uint64_t stamp_ns = 0;
  std::array<double, 3> gyro_rad_s{};
  std::array<double, 3> accel_m_s2{};
  bool measures_gyro = true;
  bool measures_accel = true;
};

/// Nothing where `message` is not a whole sensor_msgs/Imu in this encoding.
[[nodiscard]] std::optional<RosImu> read_ros_imu(std::string_view message, RosEncoding encoding);

/// The topics of a file, of which those with inertial messages make the recording (core/read/inertial_streams.hpp).
class RosTopics {
 public:
  /// An inertial message is never longer: what claims to be is no such message.
  static constexpr std::size_t kLongestMessage = std::size_t{64} * 1024;

  explicit RosTopics(ColumnSink& sink) : sink_(sink), streams_(sink, 1e9) {}

  /// A topic by its type, `sensor_msgs/Imu` or `sensor_msgs/msg/Imu`, and encoding, `ros1` or `cdr`. Error:
  /// LimitExceeded above 65536 topics.
  [[nodiscard]] Result<std::size_t> add(std::string_view name, std::string_view type, std::string_view encoding);

  /// True if its messages are wanted.
  [[nodiscard]] bool wants(std::size_t topic) const { return topics_[topic].encoding.has_value(); }

  /// One message of a wanted topic, recorded at `log_ns`.
  [[nodiscard]] Status take(std::size_t topic, std::string_view message, std::uint64_t log_ns);

  [[nodiscard]] bool empty() const { return streams_.empty(); }

  /// Delivers what is left, with notes. Error: NoSamples, naming the topics that `container` ("ROS bag") holds.
  [[nodiscard]] Status finish(const std::string& container);

 private:
  struct Topic {
    std::string name;
    std::string type;
    std::optional<RosEncoding> encoding;  ///< of wanted messages
    std::optional<std::size_t> stream;    ///< from the first message on
    bool gyro = true;
    bool accel = true;
    bool log_time = false;
  };

  ColumnSink& sink_;
  InertialStreams streams_;
  std::vector<Topic> topics_;
  std::uint64_t unreadable_ = 0;
};

}  // namespace driftlab
