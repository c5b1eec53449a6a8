#include "core/campaign/table_cells.hpp"

#include "core/process/registry.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace driftlab {
namespace {

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

/// The cell with the unit it would have, where no value says it.
ReportedValue with_unit(ReportedValue cell, std::string unit) {
  if (!cell.value) {
    cell.unit = std::move(unit);
  }
  return cell;
}

}  // namespace

ReportedValues allan_cells(const ReportedChannel& channel) {
  constexpr std::array<std::pair<std::string_view, int>, 5> kSecondPowerHalves{
      std::pair{"N", 1}, std::pair{"B", 0}, std::pair{"K", -1}, std::pair{"Q", 2}, std::pair{"R", -2}};
  ReportedValues cells;
  for (const auto& [name, halves] : kSecondPowerHalves) {
    const auto found = std::find_if(channel.allan.begin(), channel.allan.end(),
                                    [wanted = name](const auto& parameter) { return parameter.first == wanted; });
    ReportedValue cell = found == channel.allan.end() ? ReportedValue{} : found->second;
    cells.emplace_back(name, with_unit(std::move(cell), declared_unit(channel.unit, 1, halves)));
  }
  return cells;
}

ReportedValues model_cells(const ReportedFit& fit, const std::string& channel_unit) {
  ReportedValues cells;
  std::map<std::string, int> seen;
  for (const ReportedProcess& process : fit.processes) {
    const std::string& kind = process.process;
    const int index = ++seen[kind];
    const ProcessKind* const known = find_process(kind);
    const bool numbered = known != nullptr && known->repeats;  // may occur any number of times: always carries a number
    const std::string prefix = kind + (numbered ? "_" + std::to_string(index) : "") + ".";
    for (const auto& [name, value] : process.parameters) {
      cells.emplace_back(prefix + name, with_unit(value, declared_unit(channel_unit, kind, name)));
    }
  }
  return cells;
}

std::optional<double> log_half_width(const ReportedValue& cell) {
  if (!cell.value || !cell.low || !cell.high || !(*cell.low > 0.0) || !(*cell.value > 0.0)) {
    return std::nullopt;
  }
  return std::max(std::log(*cell.high / *cell.value), std::log(*cell.value / *cell.low));
}

ReportedValue averaged(const std::vector<ReportedValue>& replicates) {
  double weight_sum = 0.0;
  double log_sum = 0.0;
  const ReportedValue* any = nullptr;
  int used = 0;
  for (const ReportedValue& cell : replicates) {
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
  ReportedValue result = *any;
  const double mean = log_sum / weight_sum;
  const double half = 1.0 / std::sqrt(weight_sum);
  result.value = std::exp(mean);
  result.low = std::exp(mean - half);
  result.high = std::exp(mean + half);
  return result;
}

Scatter scatter_of(const std::vector<ReportedValue>& replicates) {
  double weights = 0.0;
  double logs = 0.0;
  double squares = 0.0;
  int used = 0;
  for (const ReportedValue& cell : replicates) {
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

std::string_view name_of(Change change) {
  switch (change) {
    case Change::None:
      return "none";
    case Change::Up:
      return "up";
    case Change::Down:
      break;
  }
  return "down";
}

std::optional<Change> change_between(const ReportedValue& first, const ReportedValue& now) {
  const auto a = log_half_width(first);
  const auto b = log_half_width(now);
  if (!a || !b || !first.value || !now.value) {
    return std::nullopt;
  }
  const double difference = std::log(*now.value / *first.value);
  if (std::fabs(difference) <= std::hypot(*a, *b)) {
    return Change::None;
  }
  return difference > 0.0 ? Change::Up : Change::Down;
}

ReportedValue ratio_of(const ReportedValue& now, const ReportedValue& reference) {
  ReportedValue ratio;
  ratio.unit = "1";
  const auto& above = now.value;
  const auto& below = reference.value;
  if (!above || !below || !(*above > 0.0) || !(*below > 0.0)) {
    return ratio;
  }
  ratio.value = *above / *below;
  const auto a = log_half_width(now);
  const auto b = log_half_width(reference);
  if (a && b) {
    const double half = std::hypot(*a, *b);
    ratio.low = *above / *below * std::exp(-half);
    ratio.high = *above / *below * std::exp(half);
  }
  return ratio;
}

std::string_view name_of(Absence absence) { return absence == Absence::NoneFound ? "none_found" : "not_identifiable"; }

Absence absence_of(std::string_view reason) {
  const auto says = [reason](std::string_view words) { return reason.find(words) != std::string_view::npos; };
  return says("the best fit has none of it") || says("has no white noise of its own") ? Absence::NoneFound
                                                                                      : Absence::NotIdentifiable;
}

}  // namespace driftlab
