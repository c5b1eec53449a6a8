#pragma once
/// The topics of a file of ROS messages, be it a ROS 1 bag, a ROS 2 bag or MCAP. Internal to core/read.
///
/// Of the topics with inertial messages one makes the recording; satellite fixes and odometry stand beside it
/// (core/read/inertial_streams.hpp). Time is that of the header's stamp; where the first message of a topic has none,
/// that of the recording, with a note.
#include "core/read/inertial_streams.hpp"
#include "core/read/ros_messages.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

class RosTopics {
 public:
  /// A message that is read is never longer: what claims to be is no such message.
  static constexpr std::size_t kLongestMessage = std::size_t{64} * 1024;

  explicit RosTopics(ColumnSink& sink) : sink_(sink), streams_(sink, 1e9) {}

  /// A topic by its type (`sensor_msgs/Imu` or `sensor_msgs/msg/Imu`, ...) and encoding, `ros1` or `cdr`. Error:
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
  enum class Content { Imu, Fix, Odometry };
  struct Topic {
    std::string name;
    std::string type;
    Content content = Content::Imu;
    std::optional<RosEncoding> encoding;  ///< of wanted messages
    std::optional<std::size_t> stream;    ///< from the first message on
    bool gyro = true;
    bool accel = true;
    bool log_time = false;
  };

  [[nodiscard]] bool take_imu(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns,
                              Status& status);
  [[nodiscard]] bool take_fix(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns);
  [[nodiscard]] bool take_odometry(Topic& topic, RosEncoding encoding, std::string_view message, std::uint64_t log_ns);

  ColumnSink& sink_;
  InertialStreams streams_;
  std::vector<Topic> topics_;
  std::uint64_t unreadable_ = 0;
};

}  // namespace driftlab
