/// imu_time_offset: the unit's clock differs from that of the fixes, by a constant and by its rate.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

std::string note_of_offset(const DriveFinding& finding, bool /*known*/) {
  if (finding.parameter == "rate") {
    return "The offset of the unit's clock changes through the drive: the value that is given is that in its middle.";
  }
  return "An offset of the unit's clock and an equal delay of all fixes are the same thing here: only the difference "
         "of "
         "the two clocks shows.";
}

}  // namespace

Cause imu_time_offset() {
  return {
      .name = "imu_time_offset",
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
                               "apart by the fixes alone"},
                {.parameter = "rate",
                 .title = "the unit's clock runs slow by",
                 .unit = "ppm",
                 .per_si = 1e6,
                 .step = 5e-5,
                 .most = 5e-3,
                 .turn = [](FilterOptions& o, double by) { o.imu_rate += by; },
                 .value = [](const FilterOptions& o) { return o.imu_rate; },
                 .told_apart = "the offset of the unit's clock grows evenly through the drive, which no delay and no "
                               "arm does"}},
      .note = note_of_offset};
}

}  // namespace driftlab::drive
