/// gnss_lever_arm: the antenna does not lie where the document says.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

template <int Axis>
constexpr Knob antenna_arm(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "m",
          .step = 0.1,
          .most = 20.0,
          .turn = [](FilterOptions& o, double by) { o.lever_arm_m(Axis) += by; },
          .value = [](const FilterOptions& o) { return o.lever_arm_m(Axis); },
          .told_apart = "constant in the body: x and y need turns, z needs slopes"};
}

}  // namespace

Cause gnss_lever_arm() {
  return {.name = "gnss_lever_arm",
          .words = "the antenna's lever arm",
          .knobs = {antenna_arm<0>("x", "the antenna lies ahead of the unit by"),
                    antenna_arm<1>("y", "the antenna lies to the right of the unit by"),
                    antenna_arm<2>("z", "the antenna lies below the unit by")}};
}

}  // namespace driftlab::drive
