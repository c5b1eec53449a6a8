#pragma once
/// Sensors as people call them where room is short.
#include <string>
#include <string_view>
#include <utility>

namespace driftlab {

/// `gyro z` for `gyroscope z`, `accel x, 9 deg/s about z` for `accelerometer x, ...`; any other name as it is.
[[nodiscard]] inline std::string short_sensor_name(const std::string& name) {
  for (const auto& [whole, part] : {std::pair{"gyroscope", "gyro"}, std::pair{"accelerometer", "accel"}}) {
    if (name.starts_with(whole)) {
      return part + name.substr(std::string_view(whole).size());
    }
  }
  return name;
}

}  // namespace driftlab
