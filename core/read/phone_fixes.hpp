#pragma once
/// Satellite fixes in what a phone application exports. Internal to core/read.
///
/// phyphox         `Location.csv`: `"Time (s)","Latitude (°)","Longitude (°)","Height (m)","Velocity (m/s)",
///                 "Direction (°)","Horizontal Accuracy (m)","Vertical Accuracy (°)"` (the last is in metres, whatever
///                 its header says); other exports have `Altitude (m)`, above the geoid, and `Altitude WGS84 (m)`.
/// Sensor Logger   `Location.csv`, of Android also `LocationGps.csv`, whose fixes are the receiver's alone:
///                 `seconds_elapsed`, `latitude`, `longitude`, `altitude` (above the ellipsoid), `speed`, `bearing` and
///                 their accuracies. A negative speed, bearing or accuracy is none, and a position whose horizontal
///                 accuracy is negative neither (the application's unit reference).
///
/// Times are on the clock of the export's other sensors.
#include "core/read/memory_table.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace driftlab {

/// Columns called as those of every log's fixes: `gnss_time (s)`, `gnss_latitude (deg)`, ... (beside_streams.hpp).
struct PhoneFixes {
  ColumnNames names;
  std::vector<std::vector<double>> columns;  ///< the time first, of one length
};

/// Whether a file of the export holds fixes, by its name in small letters without extension: 0 no, the larger the
/// better.
[[nodiscard]] int holds_fixes(std::string_view stem);

/// The fixes in a table, which is left as it is. Nothing for one without a time, a latitude or a longitude.
[[nodiscard]] std::optional<PhoneFixes> read_fixes(const MemoryTable& table);

}  // namespace driftlab
