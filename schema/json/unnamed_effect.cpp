#include "schema/json/unnamed_effect.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/process/parameter_unit.hpp"

#include <algorithm>
#include <functional>

namespace driftlab {
namespace {

using investigate::Against;
using investigate::UnnamedEffect;
using investigate::UnnamedKind;

constexpr std::size_t kMostBins = 1'000;

std::vector<double> read_numbers(const Json* list, const std::string& pointer, Faults& faults) {
  std::vector<double> values;
  const bool sound = list != nullptr && list->is_array() &&
                     std::all_of(list->begin(), list->end(), [](const Json& value) { return value.is_number(); });
  if (!sound) {
    faults.add(pointer, ErrorCode::InvalidArgument, "A list of numbers is needed here.");
    return values;
  }
  for (const Json& value : *list) {
    values.push_back(value.get<double>());
  }
  return values;
}

}  // namespace

void read_unnamed_effect(const Json& document, const std::string& pointer, investigate::Baseline& model,
                         Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const auto kind = investigate::unnamed_kind(reader.required_text("kind"));
  const auto against = investigate::unnamed_against(reader.required_text("against"));
  UnnamedEffect effect;
  effect.column = reader.required_text("channel");
  effect.edge = read_numbers(reader.member("edges"), pointer + "/edges", faults);
  effect.value = read_numbers(reader.member("values"), pointer + "/values", faults);
  const auto unit = parse_parameter_unit(reader.text("unit").value_or("1"));
  (void)reader.text("along");
  const Json* const period = reader.member("period_s");
  if (const Json* const recordings = reader.member("recordings"); recordings != nullptr && recordings->is_array()) {
    for (const Json& id : *recordings) {
      effect.recordings.push_back(id.is_string() ? id.get<std::string>() : "");
    }
  }
  reader.reject_unknown();
  if (!kind || !against || (*kind == UnnamedKind::Spectrum) != (*against == Against::Frequency)) {
    faults.add(pointer + "/kind", ErrorCode::InvalidArgument,
               "A profile is a spectrum against frequency, or a variance or a mean against time, phase, rate, "
               "angular_acceleration, temperature, warming or angle.");
    return;
  }
  if (*against == Against::Phase) {
    effect.period_s = period != nullptr && period->is_number() ? period->get<double>() : 0.0;
    if (!(effect.period_s > 0.0)) {
      faults.add(pointer + "/period_s", ErrorCode::InvalidArgument,
                 "A profile against phase has a period of more than 0 s.");
      return;
    }
  }
  if (*kind == UnnamedKind::Mean && !unit) {
    faults.add(pointer + "/unit", unit.error());
    return;
  }
  effect.kind = *kind;
  effect.against = *against;
  effect = investigate::from_lab_units(std::move(effect), unit ? unit->factor : 1.0);
  if (effect.value.empty() || effect.value.size() > kMostBins || effect.edge.size() != effect.value.size() + 1 ||
      !std::is_sorted(effect.edge.begin(), effect.edge.end(), std::less_equal<>())) {
    faults.add(pointer + "/edges", ErrorCode::InvalidArgument,
               "A profile has 1 to " + std::to_string(kMostBins) + " values and one edge more, in rising order.");
    return;
  }
  const bool negative = std::any_of(effect.value.begin(), effect.value.end(), [](double value) { return value < 0.0; });
  if (*kind != UnnamedKind::Mean && negative) {
    faults.add(pointer + "/values", ErrorCode::InvalidArgument, "The ratios of a profile are not negative.");
    return;
  }
  model.unnamed.push_back(std::move(effect));
}

Json to_json(const UnnamedEffect& effect, const Unit& channel) {
  const investigate::LabUnit level = investigate::level_unit(channel);
  const bool mean = effect.kind == UnnamedKind::Mean;
  Json item{{"kind", std::string(name_of(effect.kind))},
            {"against", std::string(name_of(effect.against))},
            {"along", investigate::unit_of(effect.against).symbol},
            {"channel", effect.column},
            {"edges", numbers(investigate::in_lab_units(effect.edge, effect.against))},
            {"values", numbers(effect.value, mean ? level.per_si : 1.0)}};
  if (effect.against == Against::Phase) {
    item["period_s"] = effect.period_s;
  }
  if (mean) {
    item["unit"] = level.symbol;
  }
  if (!effect.recordings.empty()) {
    item["recordings"] = effect.recordings;
  }
  return item;
}

Json to_json(const investigate::UnnamedFinding& found, const Unit& channel) {
  Json item = to_json(found.effect, channel);
  const bool mean = found.effect.kind == UnnamedKind::Mean;
  const double per_si = mean ? investigate::level_unit(channel).per_si : 1.0;
  item["middles"] = numbers(investigate::in_lab_units(found.middle, found.effect.against));
  item["q025"] = numbers(found.low, per_si);
  item["q975"] = numbers(found.high, per_si);
  item["gain"] = {{"log_score", number(found.heldout_gain)},
                  {"log_score_per_sample", number(found.per_sample())},
                  {"heldout_samples", number(found.samples)}};
  item["explanation"] = found.sentence;
  return item;
}

Json change_json(const investigate::UnnamedFinding& found) {
  return Json{{"change", "added"},     {"cause", "unnamed"},
              {"status", "unnamed"},   {"channels", Json::array({found.effect.column})},
              {"why", found.sentence}, {"log_score_per_sample", number(found.per_sample())}};
}

}  // namespace driftlab
