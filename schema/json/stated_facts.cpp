#include "schema/json/stated_facts.hpp"

#include "core/signal/angle.hpp"
#include "core/signal/unit.hpp"
#include "schema/json/regression.hpp"

#include <array>
#include <optional>
#include <tuple>

namespace driftlab {
namespace {

/// Members of `full_scale` with what one unit of them is in SI.
constexpr std::array<std::tuple<const char*, std::optional<double> regression::FullScales::*, double>, 2> kFullScales{
    {{"gyroscope", &regression::FullScales::gyroscope, kDegree},
     {"accelerometer", &regression::FullScales::accelerometer, kStandardGravity}}};

}  // namespace

bool StatedFacts::empty() const {
  return !temperature_degc && !full_scale.gyroscope && !full_scale.accelerometer && !causes;
}

void StatedFacts::add_causes(const std::set<std::string>& found) {
  std::set<std::string> all = found;
  if (causes) {
    all.insert(causes->begin(), causes->end());
  }
  causes.emplace(all.begin(), all.end());
}

void StatedFacts::tell(regression::ComparedRecording& recording) const {
  if (temperature_degc) {
    recording.temperature_degc = temperature_degc;  // what somebody says stands above the recording's own column
  }
  recording.full_scale = full_scale;
  recording.investigated = causes.has_value();
  recording.causes = causes.value_or(std::vector<std::string>());
}

bool is_stated_fact(std::string_view member) {
  return member == "temperature_degc" || member == "full_scale" || member == "causes";
}

StatedFacts stated_facts_from_json(ObjectReader& recording, Faults& faults) {
  StatedFacts facts;
  facts.temperature_degc = recording.real("temperature_degc");
  if (const Json* const stated = recording.member("full_scale")) {
    ObjectReader reader(*stated, recording.pointer("full_scale"), faults);
    for (const auto& [name, member, si] : kFullScales) {
      if (const auto value = reader.real(name)) {
        facts.full_scale.*member = si * *value;
        if (!(*value > 0.0)) {
          faults.add(reader.pointer(name), ErrorCode::InvalidArgument,
                     "A full scale is a positive number, of deg/s for a gyroscope and of g for an accelerometer.");
        }
      }
    }
    reader.reject_unknown();
  }
  if (const Json* const causes = recording.member("causes"); causes != nullptr && causes->is_array()) {
    facts.causes.emplace();
    for (const Json& cause : *causes) {
      facts.causes->push_back(cause.is_string() ? cause.get<std::string>() : "");
    }
  }
  return facts;
}

StatedFacts stated_facts_of(const Json& recording) {
  Faults ignored;
  ObjectReader reader(recording, "", ignored);
  return stated_facts_from_json(reader, ignored);
}

void add_stated_facts(const StatedFacts& facts, Json& recording) {
  if (facts.temperature_degc) {
    recording["temperature_degc"] = *facts.temperature_degc;
  }
  for (const auto& [name, member, si] : kFullScales) {
    if (const auto& value = facts.full_scale.*member) {
      recording["full_scale"][name] = *value / si;
    }
  }
  if (facts.causes) {
    recording["causes"] = *facts.causes;
  }
}

}  // namespace driftlab
