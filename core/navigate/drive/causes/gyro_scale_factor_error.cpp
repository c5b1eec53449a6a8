/// gyro_scale_factor_error: the gyroscope reads too much of every turn.
#include "core/navigate/drive/causes/gyroscope_error.hpp"
#include "core/navigate/drive/motion_power.hpp"

namespace driftlab::drive {
namespace {

template <int Axis>
constexpr Knob gyroscope_scale(std::string_view parameter, std::string_view title) {
  Knob knob = gyroscope_error<Axis, Axis>(parameter, title, "grows with the angle turned, with the sign of the turn");
  knob.systematic = [](const Drive& drive, const FilterOptions& o) { return scale_of_noise(drive, o, Axis); };
  return knob;
}

}  // namespace

Cause gyro_scale_factor_error() {
  return {.name = "gyro_scale_factor_error",
          .words = "scale factors of the gyroscope",
          .knobs = {gyroscope_scale<0>("x", "the gyroscope about x reads too much by"),
                    gyroscope_scale<1>("y", "the gyroscope about y reads too much by"),
                    gyroscope_scale<2>("z", "the gyroscope about z reads too much by")}};
}

}  // namespace driftlab::drive
