#include "core/campaign/sensor_sources.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace driftlab {

void add_source(std::vector<SensorSources>& sensors, TableSource source) {
  const ReportedChannel& channel = source.channel;
  const std::string& quantity = channel.quantity;
  const std::string& axis = channel.axis.empty() ? channel.channel : channel.axis;
  auto sensor = std::find_if(sensors.begin(), sensors.end(),
                             [&](const SensorSources& s) { return s.quantity == quantity && s.axis == axis; });
  if (sensor == sensors.end()) {
    sensors.push_back({quantity, axis, {}});
    sensor = sensors.end() - 1;
  }
  sensor->sources.push_back(std::move(source));
}

std::string unit_conflict(const std::vector<TableSource>& sources) {
  if (sources.empty()) {
    return "";
  }
  const Unit first = sources.front().channel.parsed_unit();
  for (const TableSource& source : sources) {
    const Unit unit = source.channel.parsed_unit();
    if (unit.dimension != first.dimension) {
      return "The channels of this axis are in units that do not convert into each other, " + first.symbol + " and " +
             unit.symbol + ".";
    }
  }
  return "";
}

const std::string& worse_verdict(const std::string& a, const std::string& b) {
  const auto badness = [](const std::string& v) {
    return v == "contaminated" ? 3 : v == "undecided" ? 2 : v.empty() ? 0 : 1;
  };
  return badness(b) > badness(a) ? b : a;
}

bool comes_before(const Condition& a, const Condition& b) {
  const auto key = [](const Condition& c) { return std::tuple(c.kind, c.axis, c.value.value_or(0.0)); };
  return key(a) != key(b) ? key(a) < key(b) : to_text(a) < to_text(b);
}

}  // namespace driftlab
