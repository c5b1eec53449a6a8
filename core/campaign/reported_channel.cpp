#include "core/campaign/reported_channel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {
namespace {

std::optional<double> finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

/// As a document has it, which knows no infinity.
double finite_or_nan(double value) { return finite(value).value_or(std::numeric_limits<double>::quiet_NaN()); }

ReportedValue told(const std::optional<Estimate>& estimate, const ParameterUnit& unit, const std::string& reason) {
  ReportedValue value;
  if (!estimate) {
    value.reason = reason;
    return value;
  }
  value.value = finite(estimate->value * unit.per_si);
  if (!value.value) {
    return value;  // a document keeps no unit and no ends of what has no value
  }
  value.low = finite(estimate->ci95.low * unit.per_si);
  value.high = finite(estimate->ci95.high * unit.per_si);
  value.unit = unit.symbol;
  return value;
}

ReportedHaar told(const HaarCurve& curve, double factor) {
  ReportedHaar haar;
  haar.scale = curve.scale;
  for (const double variance : curve.variance) {
    haar.variance.push_back(finite(variance * factor * factor).value_or(0.0));
  }
  for (const double efficiency : curve.efficiency) {
    haar.efficiency.push_back(finite(efficiency).value_or(1.0));
  }
  for (const double edf : curve.edf) {
    haar.edf.push_back(finite(edf).value_or(0.0));
  }
  const double square_factor = factor * factor;
  for (std::size_t j = 0; j < curve.robust_variance.size(); ++j) {
    const std::optional<double>& value = curve.robust_variance[j];
    haar.robust_variance.push_back(value ? finite(*value * square_factor).value_or(0.0) : 0.0);
    haar.robust_efficiency.push_back(value ? finite(curve.robust_efficiency[j]).value_or(1.0) : 1.0);
  }
  return haar;
}

}  // namespace

Unit ReportedChannel::parsed_unit() const { return parse_unit(unit).value_or(Unit{}); }

ReportedFit reported(const ModelFit& fit, const Unit& unit) {
  ReportedFit told_fit;
  told_fit.model = fit.model;
  told_fit.robust = fit.robust;
  for (const FittedProcess& process : fit.processes) {
    ReportedProcess told_process{std::string(process.kind->name), {}};
    for (const FittedParameter& parameter : process.parameters) {
      const ParameterSpec& spec = *parameter.declared;
      const Dimension dimension = spec.channel_power == 0 ? Dimension::One : unit.dimension;
      told_process.parameters.emplace_back(
          spec.name, told(parameter.estimate, lab_unit(dimension, spec.second_power_halves), parameter.reason));
    }
    told_fit.processes.push_back(std::move(told_process));
  }
  told_fit.objective = finite_or_nan(fit.objective);
  told_fit.wic = finite_or_nan(fit.wic);
  told_fit.equation_8 = finite_or_nan(fit.eq8);
  told_fit.optimism = finite_or_nan(fit.optimism);
  told_fit.condition_number = finite_or_nan(fit.condition_number);
  told_fit.bounds_active = fit.bounds_active;
  told_fit.intervals = fit.intervals;
  told_fit.plausible = fit.plausible;
  if (const auto& test = fit.j_test) {
    told_fit.j_test = JTest{finite_or_nan(test->statistic), finite_or_nan(test->dof), finite_or_nan(test->p)};
  }
  told_fit.verdict = fit.verdict;
  told_fit.described_within = fit.described_within;
  told_fit.status = fit.status;
  told_fit.warnings = fit.warnings;
  return told_fit;
}

ReportedValues reported(const AllanParameters& parameters, Dimension dimension) {
  return {{"N", told(parameters.n, lab_unit(dimension, 1), parameters.n_reason)},
          {"B", told(parameters.b, lab_unit(dimension, 0), parameters.b_reason)},
          {"K", told(parameters.k, lab_unit(dimension, -1), parameters.k_reason)},
          {"Q", told(parameters.q, lab_unit(dimension, 2), parameters.q_reason)},
          {"R", told(parameters.r, lab_unit(dimension, -2), parameters.r_reason)}};
}

ReportedChannel reported(const std::string& column, const ColumnRole& role, const ChannelCharacterisation& channel) {
  const Unit unit = role.unit.value_or(Unit{});
  ReportedChannel result;
  result.channel = column;
  result.quantity = name_of(role.quantity);
  result.axis = role.axis;
  result.unit = unit.symbol;
  result.samples = channel.samples;
  result.missing = channel.missing;
  result.dt_s = channel.dt_s;
  result.haar = told(channel.haar, 1.0 / unit.factor);
  result.contamination = channel.contamination.verdict;
  result.discrepancy = finite(channel.discrepancy).value_or(0.0);
  result.from_tau_s = channel.from_tau_s;
  result.allan = reported(channel.allan_parameters, unit.dimension);
  for (const ModelFit& fit : channel.fits) {
    result.fits.push_back(reported(fit, unit));
  }
  result.description = channel.description ? channel.description->sentence : "";
  return result;
}

const ReportedFit* find_fit(const std::vector<ReportedFit>& fits, const std::string& model) {
  const auto found = std::find_if(fits.begin(), fits.end(), [&](const ReportedFit& fit) { return fit.model == model; });
  return found == fits.end() ? nullptr : &*found;
}

}  // namespace driftlab
