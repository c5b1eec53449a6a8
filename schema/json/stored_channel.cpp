#include "schema/json/stored_channel.hpp"

#include "schema/json/figure_values.hpp"
#include "schema/json/reported_channel.hpp"

#include <utility>

namespace driftlab {
namespace {

template <class Value>
Json listed(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const std::optional<double> value : values) {
    list.push_back(value ? number(*value) : Json(nullptr));
  }
  return list;
}

/// The member where it is an object, else null.
const Json& object_member(const Json& document, const char* name) {
  static const Json none;
  const auto found = document.find(name);
  return found != document.end() && found->is_object() ? *found : none;
}

MeasuredDeviation deviation_from_json(const Json& allan) {
  if (allan.is_null()) {
    return {};
  }
  const Json& ci95 = allan.at("ci95");
  return {allan.at("tau_s").get<std::vector<double>>(), values_of(allan.at("deviation")), ends_of(ci95, 0),
          ends_of(ci95, 1)};
}

DrawnCurve variances_from_json(const Json& robust) {
  if (robust.is_null()) {
    return {};
  }
  return {{}, values_of(robust.at("variance")), ends_of(robust.at("ci95"), 0), ends_of(robust.at("ci95"), 1)};
}

Json to_json(const MeasuredOverModel& at_measured) {
  Json ci95 = Json::array();
  for (std::size_t i = 0; i < at_measured.ratio.size(); ++i) {
    ci95.push_back(listed(std::vector{at_measured.low[i], at_measured.high[i]}));
  }
  return Json{{"tau_s", listed(at_measured.tau_s)},
              {"deviation", listed(at_measured.deviation)},
              {"measured_over_model", listed(at_measured.ratio)},
              {"ci95", std::move(ci95)}};
}

}  // namespace

Result<StoredChannel> stored_channel_from_json(const Json& channel) {
  auto told = reported_channel_from_json(channel);
  if (!told) {
    return fail(told.error());
  }
  try {
    const auto best = channel.find("best");
    return StoredChannel{*std::move(told), contamination_from_json(channel),
                         deviation_from_json(object_member(channel, "allan")),
                         variances_from_json(object_member(channel.at("haar"), "robust")),
                         best != channel.end() && best->is_number_unsigned() ? best->get<std::size_t>() : 0};
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A stored channel cannot be read: " + std::string(fault.what()) + ".");
  }
}

std::vector<StoredChannel> stored_channels_from_json(const Json& channels) {
  std::vector<StoredChannel> read;
  for (const Json& channel : channels) {
    if (auto stored = stored_channel_from_json(channel)) {
      read.push_back(*std::move(stored));
    }
  }
  return read;
}

Json to_json(const Verdict& verdict) {
  Json facts = Json::array();
  for (const auto& [pointer, value] : verdict.facts) {
    facts.push_back(Json{{"pointer", pointer}, {"value", number(value)}});
  }
  return Json{{"verdict", verdict.sentence},
              {"details", verdict.details},
              {"level", name_of(verdict.level)},
              {"facts", std::move(facts)}};
}

Json to_json(const ImpliedBeside& implied, const std::string& unit) {
  Json deviations = Json::array();
  Json densities = Json::array();
  for (const ImpliedComponent& component : implied.curves.components) {
    deviations.push_back(Json{{"process", component.process}, {"deviation", listed(component.deviation)}});
    densities.push_back(Json{{"process", component.process}, {"density", listed(component.density)}});
  }
  return Json{{"unit", unit},
              {"allan",
               {{"tau_s", listed(implied.curves.tau_s)},
                {"deviation", listed(implied.curves.deviation)},
                {"components", std::move(deviations)}}},
              {"spectrum",
               {{"f_hz", listed(implied.curves.f_hz)},
                {"density", listed(implied.curves.density)},
                {"components", std::move(densities)}}},
              {"ratio", to_json(implied.at_measured)}};
}

}  // namespace driftlab
