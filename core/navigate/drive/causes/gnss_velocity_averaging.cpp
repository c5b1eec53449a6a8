/// gnss_velocity_averaging: the velocities of fixes are means over the time before them.
///
/// A receiver that differences carrier phases gives the mean velocity over the time T since its last epoch. That is a
/// velocity T/2 old (gnss_velocity_latency) but for T^2/24 of the rate of change of the acceleration: 5 mm/s where a
/// road vehicle changes its acceleration by 2 m/s^3 and T is 0.25 s, less than the noise of a velocity. It goes with
/// the vehicle's pitching, though, by which it looks like an antenna that is higher or lower than it is.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

constexpr double kShortest = 0.02;  ///< [s] by which velocities are older than positions; chosen, not measured
constexpr double kLongest = 1.0;    ///< [s]; what is older is stated, or waits on a line

constexpr Knob kAveragingKnob{.parameter = "share",
                              .title = "velocities of fixes are as smooth as means over twice their delay, to",
                              .unit = "%",
                              .per_si = 100.0,
                              .step = 0.25,
                              .most = 1.0,
                              .turn = [](FilterOptions& o, double by) { o.velocity_averaging += by; },
                              .value = [](const FilterOptions& o) { return o.velocity_averaging; },
                              .applies =
                                  [](const Drive& drive, const FilterOptions& o) {
                                    const double older = o.velocity_latency_s - o.position_latency_s;
                                    return older > kShortest && older <= kLongest && !drive.fixes.empty() &&
                                           drive.fixes[drive.fixes.size() / 2].velocity_ned_m_s.has_value();
                                  },
                              .told_apart =
                                  "where the acceleration changes: a delay alone leaves velocities as sharp as they "
                                  "are, an arm upwards shows in turns about any level axis",
                              .share = true};

}  // namespace

Cause gnss_velocity_averaging() {
  return {.name = "gnss_velocity_averaging", .words = "averaged velocities of fixes", .knobs = {kAveragingKnob}};
}

}  // namespace driftlab::drive
