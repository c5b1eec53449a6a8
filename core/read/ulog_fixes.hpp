#pragma once
/// Satellite fixes of a ULog: the topics vehicle_gps_position and sensor_gps. Internal to core/read.
///
/// Both hold what one receiver says; vehicle_gps_position is the one that the flight controller navigates by.
/// Positions come as 1e-7 deg and mm, since PX4 1.15 as degrees and metres. Source: PX4 user guide, "SensorGps (UORB
/// message)".
#include "core/read/format.hpp"
#include "core/read/ulog_format.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace driftlab::ulog {

/// How the data of a topic become a row.
struct FixLayout {
  struct Value {
    Place place;
    double unit = 1.0;  ///< of the column in one of the field's
  };
  std::size_t stamp = 0;      ///< of a uint64_t in microseconds since boot
  ColumnNames columns;        ///< without the time
  std::vector<Value> values;  ///< of the columns
  std::size_t bytes = 0;      ///< that the data must have
};

/// Nothing where the topic holds no fixes or is not declared with a latitude, a longitude and a stamp.
[[nodiscard]] std::optional<FixLayout> fix_layout(const Definitions& definitions, std::string_view topic);

}  // namespace driftlab::ulog
