/// imu_time_offset: the unit's clock differs from that of the fixes.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

std::string note_of_offset(const DriveFinding& /*finding*/, bool /*known*/) {
  return "An offset of the unit's clock and an equal delay of all fixes are the same thing here: only the difference "
         "of "
         "the two clocks shows.";
}

}  // namespace

Cause imu_time_offset() {
  return {.name = "imu_time_offset",
          .words = "an offset of the unit's clock",
          .knobs = {{.parameter = "delta_s",
                     .title = "the unit's clock is off by",
                     .unit = "s",
                     .step = 0.02,
                     .most = 2.0,
                     .turn = [](FilterOptions& o, double by) { o.imu_offset_s += by; },
                     .value = [](const FilterOptions& o) { return o.imu_offset_s; },
                     .told_apart = "grows with speed along the way; a late position alone is the same thing, since "
                                   "only the difference of the two clocks shows, and the velocity's own delay is told "
                                   "apart by the fixes alone"}},
          .note = note_of_offset};
}

}  // namespace driftlab::drive
