/// mounting_angles: the unit is turned against the way of the vehicle, or lies elsewhere than its axle. Only velocity
/// constraints show it.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/signal/angle.hpp"

namespace driftlab::drive {
namespace {

constexpr double kAxleSd = 1.5;  ///< [m]: where a vehicle's axle lies no document says

template <double Constraint::* Member>
constexpr Knob turned_mounting(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "deg",
          .per_si = 1.0 / kDegree,
          .step = 0.5 * kDegree,
          .most = 0.6,
          .turn = [](FilterOptions& o, double by) { (*o.constraint).*Member += by; },
          .value = [](const FilterOptions& o) { return o.constraint ? (*o.constraint).*Member : 0.0; },
          .applies = [](const Drive&, const FilterOptions& o) { return o.constraint.has_value(); },
          .told_apart = "sideways velocity in proportion to speed; the arm to the axle in proportion to turning",
          .prior_sd = [](const Document& document,
                         const FilterOptions& o) { return o.constraint ? document.imu.mounting_sd_rad : 0.0; }};
}

}  // namespace

Cause mounting_angles() {
  Knob axle = turned_mounting<&Constraint::axle_m>("axle", "the axle that does not slip lies ahead of the unit by");
  axle.unit = "m";
  axle.per_si = 1.0;
  axle.step = 0.2;
  axle.most = 10.0;
  axle.prior_sd = [](const Document&, const FilterOptions& o) { return o.constraint ? kAxleSd : 0.0; };
  return {.name = "mounting_angles",
          .words = "how the unit is mounted",
          .knobs = {
              turned_mounting<&Constraint::yaw_rad>("yaw", "the unit is turned against the vehicle about down by"),
              turned_mounting<&Constraint::pitch_rad>("pitch", "the unit is turned against the vehicle about right by"),
              axle}};
}

}  // namespace driftlab::drive
