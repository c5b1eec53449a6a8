#include "core/investigate/causes/evidence.hpp"

#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

LabUnit level_unit(const Unit& channel, std::string_view suffix) {
  LabUnit unit;
  switch (channel.dimension) {
    case Dimension::AngularRate:
      unit = {"deg/s", 1.0 / kDegree};
      break;
    case Dimension::SpecificForce:
      unit = {"m/s^2", 1.0};
      break;
    default:
      unit = {"1", 1.0};
      break;
  }
  unit.symbol.append(suffix);
  return unit;
}

double choice_penalty(double choices) { return 2.0 * std::log(std::max(1.0, choices)); }

}  // namespace driftlab::investigate
