#pragma once
/// Satellite fixes of a ULog: the topics vehicle_gps_position and sensor_gps. Internal to core/read.
///
/// Both hold the fixes of a receiver; those of vehicle_gps_position are the ones that the flight controller navigates
/// by. Positions come as 1e-7 deg and mm, since PX4 1.15 as degrees and metres. Source: PX4 user guide, "SensorGps
/// (UORB message)".
#include "core/read/format.hpp"
#include "core/read/ulog_format.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace driftlab::ulog {

/// Where the values of one row lie in the data of a message.
struct FixLayout {
  struct Value {
    Place place;
    double unit = 1.0;  ///< units of the column in one unit of the field
  };
  std::size_t stamp = 0;      ///< place of the time stamp, a uint64_t in microseconds since boot
  ColumnNames columns;        ///< without the time
  std::vector<Value> values;  ///< one per column
  std::size_t bytes = 0;      ///< least length of the data
};

/// The layout of a topic of fixes. Nothing for any other topic, and for one that is not declared with a latitude, a
/// longitude and a time stamp.
[[nodiscard]] std::optional<FixLayout> fix_layout(const Definitions& definitions, std::string_view topic);

}  // namespace driftlab::ulog
