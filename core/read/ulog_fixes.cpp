#include "core/read/ulog_fixes.hpp"

#include <algorithm>
#include <array>

namespace driftlab::ulog {
namespace {

/// A column, and the fields that it may come from, the first that is declared.
struct Wanted {
  std::string_view column;
  std::string_view field;
  double unit;
  std::string_view older_field;
  double older_unit;
};

constexpr std::array kWanted{
    Wanted{"latitude (deg)", "latitude_deg", 1.0, "lat", 1e-7},
    Wanted{"longitude (deg)", "longitude_deg", 1.0, "lon", 1e-7},
    Wanted{"height (m)", "altitude_ellipsoid_m", 1.0, "alt_ellipsoid", 1e-3},
    Wanted{"altitude (m)", "altitude_msl_m", 1.0, "alt", 1e-3},
    Wanted{"velocity_north (m/s)", "vel_n_m_s", 1.0, "", 0.0},
    Wanted{"velocity_east (m/s)", "vel_e_m_s", 1.0, "", 0.0},
    Wanted{"velocity_down (m/s)", "vel_d_m_s", 1.0, "", 0.0},
    Wanted{"sd_horizontal (m)", "eph", 1.0, "", 0.0},
    Wanted{"sd_vertical (m)", "epv", 1.0, "", 0.0},
    Wanted{"sd_speed (m/s)", "s_variance_m_s", 1.0, "", 0.0},
    Wanted{"fix_type", "fix_type", 1.0, "", 0.0},
    Wanted{"satellites", "satellites_used", 1.0, "", 0.0},
    Wanted{"utc (s)", "time_utc_usec", 1e-6, "", 0.0},
};
constexpr std::size_t kPlace = 2;  ///< of the first columns have to be there

}  // namespace

std::optional<FixLayout> fix_layout(const Definitions& definitions, std::string_view topic) {
  if (topic != "vehicle_gps_position" && topic != "sensor_gps") {
    return std::nullopt;
  }
  auto stamp = find_field(definitions, topic, "timestamp_sample");
  stamp = stamp ? stamp : find_field(definitions, topic, "timestamp");
  if (!stamp || stamp->type != "uint64_t") {
    return std::nullopt;
  }
  FixLayout layout;
  layout.stamp = stamp->offset;
  layout.bytes = stamp->offset + sizeof(std::uint64_t);
  for (const Wanted& wanted : kWanted) {
    auto place = find_field(definitions, topic, wanted.field);
    double unit = wanted.unit;
    if (!place && !wanted.older_field.empty()) {
      place = find_field(definitions, topic, wanted.older_field);
      unit = wanted.older_unit;
    }
    if (place && place->count == 1) {
      layout.columns.emplace_back(wanted.column);
      layout.values.push_back({*place, unit});
      layout.bytes = std::max(layout.bytes, place->offset + bytes_of(*place));
    } else if (layout.columns.size() < kPlace) {
      return std::nullopt;
    }
  }
  return layout;
}

}  // namespace driftlab::ulog
