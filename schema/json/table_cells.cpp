#include "schema/json/table_cells.hpp"

#include "core/process/registry.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace driftlab {
namespace {

std::optional<double> optional_number(const Json& value) {
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

/// The unit of a parameter of a channel in `channel_unit`; empty where that unit is not known.
std::string declared_unit(const std::string& channel_unit, int channel_power, int second_power_halves) {
  const auto unit = parse_unit(channel_unit);
  if (!unit) {
    return "";
  }
  return lab_unit(channel_power == 0 ? Dimension::One : unit->dimension, second_power_halves).symbol;
}

std::string declared_unit(const std::string& channel_unit, const std::string& process, const std::string& parameter) {
  const ProcessKind* const kind = find_process(process);
  if (kind == nullptr) {
    return "";
  }
  for (const ParameterSpec& spec : kind->parameters) {
    if (spec.name == parameter) {
      return declared_unit(channel_unit, spec.channel_power, spec.second_power_halves);
    }
  }
  return "";
}

/// `unit`: where no value says it.
Cell cell_of(const Json& parameter, const Json* reasons, const std::string& name, std::string unit) {
  Cell cell;
  cell.unit = std::move(unit);
  if (parameter.is_object()) {
    cell.value = optional_number(parameter.value("value", Json()));
    cell.unit = parameter.value("unit", cell.unit);
    cell.low = optional_number(parameter["ci95"][0]);
    cell.high = optional_number(parameter["ci95"][1]);
  } else if (reasons != nullptr && reasons->contains(name)) {
    cell.reason = (*reasons)[name].get<std::string>();
  }
  return cell;
}

}  // namespace

Cells allan_cells(const Json& channel) {
  Cells cells;
  const Json& parameters = channel.at("allan_parameters");
  const auto reasons = parameters.find("reasons");
  const std::string unit = channel.value("unit", "");
  constexpr std::array<std::pair<const char*, int>, 5> kSecondPowerHalves{
      std::pair{"N", 1}, std::pair{"B", 0}, std::pair{"K", -1}, std::pair{"Q", 2}, std::pair{"R", -2}};
  for (const auto& [name, halves] : kSecondPowerHalves) {
    cells.emplace_back(name, cell_of(parameters.value(name, Json()), reasons == parameters.end() ? nullptr : &*reasons,
                                     name, declared_unit(unit, 1, halves)));
  }
  return cells;
}

const Json* find_fit(const Json& channel, const std::string& model) {
  for (const Json& fit : channel.at("fits")) {
    if (fit.value("model", "") == model) {
      return &fit;
    }
  }
  return nullptr;
}

Cells model_cells(const Json& fit, const std::string& channel_unit) {
  Cells cells;
  std::map<std::string, int> seen;
  for (const Json& process : fit.at("processes")) {
    const std::string kind = process.value("process", "");
    const int index = ++seen[kind];
    // Gauss-Markov processes and sinusoids may occur any number of times, so they always carry a number.
    const bool numbered = kind == "gauss_markov" || kind == "sinusoid";
    const std::string prefix = kind + (numbered ? "_" + std::to_string(index) : "") + ".";
    const auto reasons = process.find("reasons");
    for (const auto& [name, parameter] : process.at("params").items()) {
      cells.emplace_back(prefix + name, cell_of(parameter, reasons == process.end() ? nullptr : &*reasons, name,
                                                declared_unit(channel_unit, kind, name)));
    }
  }
  return cells;
}

std::optional<double> log_half_width(const Cell& cell) {
  if (!cell.value || !cell.low || !cell.high || !(*cell.low > 0.0) || !(*cell.value > 0.0)) {
    return std::nullopt;
  }
  return std::max(std::log(*cell.high / *cell.value), std::log(*cell.value / *cell.low));
}

Cell averaged(const std::vector<Cell>& replicates) {
  double weight_sum = 0.0;
  double log_sum = 0.0;
  const Cell* any = nullptr;
  int used = 0;
  for (const Cell& cell : replicates) {
    if (!cell.value) {
      continue;
    }
    any = &cell;
    const auto& value = cell.value;
    if (const auto half = log_half_width(cell); half && *half > 0.0 && value) {
      const double weight = 1.0 / (*half * *half);
      weight_sum += weight;
      log_sum += weight * std::log(*value);
      ++used;
    }
  }
  if (used < 2) {
    return any != nullptr ? *any : replicates.front();
  }
  Cell result = *any;
  const double mean = log_sum / weight_sum;
  const double half = 1.0 / std::sqrt(weight_sum);
  result.value = std::exp(mean);
  result.low = std::exp(mean - half);
  result.high = std::exp(mean + half);
  return result;
}

Scatter scatter_of(const std::vector<Cell>& replicates) {
  double weights = 0.0;
  double logs = 0.0;
  double squares = 0.0;
  int used = 0;
  for (const Cell& cell : replicates) {
    const auto& value = cell.value;
    if (const auto half = log_half_width(cell); half && *half > 0.0 && value) {
      constexpr double kZ95 = 1.959963984540054;
      const double weight = kZ95 * kZ95 / (*half * *half);
      const double y = std::log(*value);
      weights += weight;
      logs += weight * y;
      squares += weight * y * y;
      ++used;
    }
  }
  return used < 2 ? Scatter{} : Scatter{std::max(0.0, squares - logs * logs / weights), used - 1};
}

Json change_between(const Cell& first, const Cell& now) {
  const auto a = log_half_width(first);
  const auto b = log_half_width(now);
  if (!a || !b || !first.value || !now.value) {
    return nullptr;
  }
  const double difference = std::log(*now.value / *first.value);
  if (std::fabs(difference) <= std::hypot(*a, *b)) {
    return "none";
  }
  return difference > 0.0 ? "up" : "down";
}

bool comes_before(const Condition& a, const Condition& b) {
  const auto key = [](const Condition& c) { return std::tuple(c.kind, c.axis, c.value.value_or(0.0)); };
  return key(a) != key(b) ? key(a) < key(b) : to_text(a) < to_text(b);
}

}  // namespace driftlab
