#include "core/investigate/causes/evidence.hpp"

#include "core/investigate/causes/cause.hpp"
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

std::string spoken_name(std::string_view parameter) {
  for (const std::string_view unit : {"_hz", "_s", "_deg"}) {
    if (parameter.ends_with(unit)) {
      parameter.remove_suffix(unit.size());
      break;
    }
  }
  std::string name(parameter);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::vector<std::string> alternatives_of(const Evidence& evidence) {
  std::vector<std::string> alternatives;
  for (const Evidence& rival : evidence.rivals) {
    alternatives.emplace_back(rival.cause->name);
  }
  if (!evidence.doubt.empty()) {
    if (alternatives.size() >= kMostAlternatives) {
      alternatives.resize(kMostAlternatives - 1);
    }
    alternatives.emplace_back("unnamed");
  }
  return alternatives;
}

double choice_penalty(double choices) { return 2.0 * std::log(std::max(1.0, choices)); }

}  // namespace driftlab::investigate
