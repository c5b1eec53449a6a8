#include "core/campaign/rate_models.hpp"

#include "core/campaign/trend_table.hpp"
#include "core/process/parameter_unit.hpp"
#include "core/process/registry.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab {
namespace {

/// Where a column of the table goes: `gauss_markov_2.beta` is a parameter of the third process, say.
struct ColumnPlace {
  std::size_t column = 0;
  std::size_t process = 0;
  std::size_t parameter = 0;
  double to_si = 1.0;
};

struct ModelLayout {
  std::vector<const ProcessKind*> kinds;
  std::vector<ColumnPlace> places;
};

/// `gauss_markov_2` -> gauss_markov.
const ProcessKind* kind_of_key(std::string_view name) {
  if (const ProcessKind* const kind = find_process(name)) {
    return kind;
  }
  return find_process(name.substr(0, name.find_last_of('_')));
}

/// Adds a column; false where it is no parameter of an angular rate's process.
bool add_column(ModelLayout& layout, std::vector<std::string>& prefixes, std::size_t index, const TableColumn& column) {
  const std::string& key = column.key;
  const bool allan = key == "N";
  const std::size_t dot = key.find('.');
  const std::string prefix = allan ? "white_noise" : key.substr(0, dot);
  const std::string parameter = allan ? key : dot == std::string::npos ? "" : key.substr(dot + 1);
  const ProcessKind* const kind = kind_of_key(prefix);
  if (kind == nullptr || column.unit.empty()) {
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
      const auto factor = parameter_factor(column.unit, Dimension::AngularRate, kind->parameters[p]);
      layout.places.push_back({index, static_cast<std::size_t>(at - prefixes.begin()), p, factor.value_or(0.0)});
      return factor.has_value();
    }
  }
  return false;
}

/// Nothing where the table is not that of a gyroscope's model.
std::optional<ModelLayout> layout_of(const ParameterTable& table) {
  ModelLayout layout;
  std::vector<std::string> prefixes;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool shape_only = table.method == TableMethod::Av && table.columns[c].key != "N";
    if (!shape_only && !add_column(layout, prefixes, c, table.columns[c])) {
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
std::optional<double> rate_of(const Condition& condition) {
  if (condition.kind == ConditionKind::Static) {
    return 0.0;
  }
  return condition.kind == ConditionKind::ConstantRate && condition.value ? std::optional(std::fabs(*condition.value))
                                                                          : std::nullopt;
}

/// Logarithms of a row's parameters; nothing where one is not identified.
std::optional<std::vector<double>> logs_of(const TableRow& row, const ModelLayout& layout) {
  std::vector<double> logs;
  for (const ColumnPlace& place : layout.places) {
    const std::optional<double>& value = row.cells[place.column].estimate.value;
    if (!value || !(*value > 0.0)) {
      return std::nullopt;
    }
    logs.push_back(std::log(*value * place.to_si));
  }
  return logs;
}

struct LogSum {
  std::vector<double> sum;
  double rows = 0.0;
};

Model mean_model(const LogSum& averaged, const ModelLayout& layout) {
  Model model;
  for (const ProcessKind* const kind : layout.kinds) {
    model.push_back({kind, std::vector<double>(kind->parameters.size())});
  }
  for (std::size_t k = 0; k < layout.places.size(); ++k) {
    const ColumnPlace& place = layout.places[k];
    model[place.process].parameters[place.parameter] = std::exp(averaged.sum[k] / averaged.rows);
  }
  return model;
}

std::vector<RateRelation> relations_of(const ParameterTable& table, const ModelLayout& layout) {
  std::vector<RateRelation> relations;
  for (const ColumnTrend& followed : build_trends(table).trends) {
    const auto place = std::find_if(layout.places.begin(), layout.places.end(), [&](const ColumnPlace& p) {
      return table.columns[p.column].key == followed.column.key;
    });
    if (followed.against != Dynamics::Rate || place == layout.places.end()) {
      continue;
    }
    FittedRelation relation = followed.trend.relation;
    relation.low *= place->to_si;
    relation.high *= place->to_si;
    relation.scale *= kDegree;
    relations.push_back({place->process, place->parameter, relation});
  }
  return relations;
}

}  // namespace

Result<RateModels> models_by_rate(const ParameterTable& table) {
  const auto layout = layout_of(table);
  if (!layout) {
    return fail(ErrorCode::InvalidArgument, "This is no parameter table of a gyroscope.");
  }
  std::map<double, LogSum> by_rate;
  for (const TableRow& row : table.rows) {
    const auto rate = rate_of(row.condition);
    const auto logs = rate ? logs_of(row, *layout) : std::nullopt;
    if (!logs) {
      continue;
    }
    LogSum& averaged = by_rate[*rate];
    averaged.sum.resize(logs->size());
    for (std::size_t k = 0; k < logs->size(); ++k) {
      averaged.sum[k] += (*logs)[k];
    }
    averaged.rows += 1.0;
  }
  if (by_rate.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "The table has no row at rest or at a constant rate that identifies every parameter of its model.");
  }
  RateModels result;
  for (const auto& [rate, averaged] : by_rate) {
    result.rates_rad_s.push_back(rate);
    result.models.push_back(mean_model(averaged, *layout));
  }
  result.relations = relations_of(table, *layout);
  return result;
}

}  // namespace driftlab
