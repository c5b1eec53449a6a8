#include "schema/json/table_schedule.hpp"

#include "core/navigate/trend_schedule.hpp"
#include "core/process/registry.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/trend_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace driftlab {
namespace {

/// Where a column of the table goes: `gauss_markov_2.beta` is a parameter of the third process, say.
struct Place {
  std::string key;
  std::size_t process = 0;
  std::size_t parameter = 0;
  double to_si = 1.0;
};

struct Layout {
  std::vector<const ProcessKind*> kinds;
  std::vector<Place> places;
};

/// `gauss_markov_2` -> gauss_markov.
const ProcessKind* kind_of_key(std::string_view name) {
  if (const ProcessKind* const kind = find_process(name)) {
    return kind;
  }
  return find_process(name.substr(0, name.find_last_of('_')));
}

/// Adds a column; false where it is no parameter of an angular rate's process.
bool add_column(Layout& layout, std::vector<std::string>& prefixes, const std::string& key, const Json& unit) {
  const bool allan = key == "N";
  const std::size_t dot = key.find('.');
  const std::string prefix = allan ? "white_noise" : key.substr(0, dot);
  const std::string parameter = allan ? key : dot == std::string::npos ? "" : key.substr(dot + 1);
  const ProcessKind* const kind = kind_of_key(prefix);
  if (kind == nullptr || !unit.is_string()) {
    return false;
  }
  auto at = std::find(prefixes.begin(), prefixes.end(), prefix);
  if (at == prefixes.end()) {
    prefixes.push_back(prefix);
    layout.kinds.push_back(kind);
    at = prefixes.end() - 1;
  }
  for (std::size_t p = 0; p < kind->parameters.size(); ++p) {
    if (kind->parameters[p].name == parameter) {
      const auto factor =
          parameter_factor(unit.get_ref<const std::string&>(), Dimension::AngularRate, kind->parameters[p]);
      layout.places.push_back({key, static_cast<std::size_t>(at - prefixes.begin()), p, factor.value_or(0.0)});
      return factor.has_value();
    }
  }
  return false;
}

/// Nothing where the table is not that of a gyroscope's model.
std::optional<Layout> layout_of(const Json& table) {
  Layout layout;
  std::vector<std::string> prefixes;
  const bool allan = table.value("method", Json()) == "av";
  for (const Json& column : table.at("columns")) {
    const std::string key = column.value("key", "");
    if (allan && key != "N") {
      continue;  // the other coefficients of the Allan deviation describe a shape, not a process of the filter
    }
    if (!add_column(layout, prefixes, key, column.contains("unit") ? column["unit"] : Json())) {
      return std::nullopt;
    }
  }
  std::size_t needed = 0;
  for (const ProcessKind* const kind : layout.kinds) {
    needed += kind->parameters.size();
  }
  return needed > 0 && needed == layout.places.size() ? std::optional(layout) : std::nullopt;
}

/// |rate| of a row [rad/s]; nothing for other kinds of motion.
std::optional<double> rate_of(const Json& row) {
  Faults ignored;
  const Condition condition = condition_from_json(row.at("condition"), "", ignored);
  if (condition.kind == ConditionKind::Static) {
    return 0.0;
  }
  return condition.kind == ConditionKind::ConstantRate && condition.value ? std::optional(std::fabs(*condition.value))
                                                                          : std::nullopt;
}

/// Logarithms of a row's parameters; nothing where one is not identified.
std::optional<std::vector<double>> logs_of(const Json& row, const Layout& layout) {
  std::vector<double> logs;
  for (const Place& place : layout.places) {
    const Json& cell = row.at("values").contains(place.key) ? row["values"][place.key] : Json();
    if (!cell.is_object() || !cell["value"].is_number() || !(cell["value"].get<double>() > 0.0)) {
      return std::nullopt;
    }
    logs.push_back(std::log(cell["value"].get<double>() * place.to_si));
  }
  return logs;
}

struct Averaged {
  std::vector<double> sum;
  double rows = 0.0;
};

Model model_of(const Averaged& averaged, const Layout& layout) {
  Model model;
  for (const ProcessKind* const kind : layout.kinds) {
    model.push_back({kind, std::vector<double>(kind->parameters.size())});
  }
  for (std::size_t k = 0; k < layout.places.size(); ++k) {
    const Place& place = layout.places[k];
    model[place.process].parameters[place.parameter] = std::exp(averaged.sum[k] / averaged.rows);
  }
  return model;
}

std::vector<ParameterTrend> trends_of(const Json& table, const Layout& layout) {
  std::vector<ParameterTrend> trends;
  const Json document = build_trends(table);
  for (const Json& trend : document["trends"]) {
    const auto place = std::find_if(layout.places.begin(), layout.places.end(),
                                    [&](const Place& p) { return trend["parameter"] == p.key; });
    if (trend["against"]["kind"] != "rate" || place == layout.places.end()) {
      continue;
    }
    const Json& fitted = trend["relation"];
    FittedRelation relation;
    relation.low = fitted["low"].get<double>() * place->to_si;
    relation.high = fitted["high"].get<double>() * place->to_si;
    relation.exponent = fitted["exponent"].get<double>();
    relation.scale = fitted["scale"].get<double>() * kDegree;
    trends.push_back({place->process, place->parameter, relation});
  }
  return trends;
}

}  // namespace

ModelSchedule schedule_from_table(const Json& table, const TableScheduleOptions& options, const std::string& pointer,
                                  Faults& faults) {
  const bool whole = table.is_object() && table.contains("columns") && table["columns"].is_array() &&
                     table.contains("rows") && table["rows"].is_array() && table.contains("method");
  const auto layout = whole ? layout_of(table) : std::nullopt;
  if (!layout) {
    faults.add(pointer, ErrorCode::InvalidArgument, "This is no parameter table of a gyroscope.");
    return {};
  }
  std::map<double, Averaged> by_rate;
  for (const Json& row : table["rows"]) {
    const auto rate = rate_of(row);
    const auto logs = rate ? logs_of(row, *layout) : std::nullopt;
    if (!logs) {
      continue;
    }
    Averaged& averaged = by_rate[*rate];
    averaged.sum.resize(logs->size());
    for (std::size_t k = 0; k < logs->size(); ++k) {
      averaged.sum[k] += (*logs)[k];
    }
    averaged.rows += 1.0;
  }
  if (by_rate.empty()) {
    faults.add(pointer, ErrorCode::InvalidArgument,
               "The table has no row at rest or at a constant rate that identifies every parameter of its model.");
    return {};
  }
  std::vector<double> bounds;
  std::vector<Model> models;
  double before = 0.0;
  for (const auto& [rate, averaged] : by_rate) {
    if (!models.empty()) {
      bounds.push_back(0.5 * (before + rate));
    }
    before = rate;
    models.push_back(model_of(averaged, *layout));
  }
  auto schedule = options.continuous ? schedule_along(models.front(), trends_of(table, *layout), options.step_rad_s)
                                     : ModelSchedule::by_rate(bounds, models, options.hysteresis_rad_s);
  if (!schedule) {
    faults.add(pointer, schedule.error());
    return {};
  }
  return std::move(*schedule);
}

}  // namespace driftlab
