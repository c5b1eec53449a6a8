#include "core/fit/fit_report.hpp"

#include "core/fit/j_test.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <system_error>

namespace driftlab {
namespace {

/// A preview whose logarithm is this uncertain is no estimate.
constexpr double kPreviewLimit = 2.0;
constexpr double kPoorlyConditioned = 1e4;

/// Fast noise that a filter or a quick process has coloured is no absence of noise: N at low frequencies is what it is.
std::string vanished(const ProcessKind& kind) {
  if (kind.white_square != nullptr) {
    return "The best fit of this model has no white noise of its own, for a faster process stands in its place; the "
           "density N at low frequencies is given beside it.";
  }
  return "The data show no " + std::string(kind.title) + ": the best fit has none of it.";
}

/// Interval of coordinate `k`, in the coordinate (2 ln level or ln shape).
Interval coordinate_interval(LogFit& fit, std::size_t k, IntervalMethod method, double rise) {
  if (method == IntervalMethod::Profile) {
    return fit.profile(k, rise);
  }
  const double error = fit.sandwich()(static_cast<Eigen::Index>(k));
  if (!(error * std::sqrt(rise / kRise95) < 2.0 * kPreviewLimit)) {
    return {};
  }
  const double half_width = std::sqrt(rise) * error;
  return {fit.best()(static_cast<Eigen::Index>(k)) - half_width, fit.best()(static_cast<Eigen::Index>(k)) + half_width};
}

struct Reported {
  std::optional<Estimate> estimate;
  std::string reason;
  double upper_limit = kUnbounded;
};

Reported report_parameter(Candidate& candidate, const Process& process, std::size_t active_index, std::size_t parameter,
                          IntervalMethod method, const std::function<double(std::size_t)>& rise_of) {
  LogFit& fit = *candidate.log_fit;
  const auto& coordinates = fit.coordinates();
  const auto found = std::find_if(coordinates.begin(), coordinates.end(), [&](const LogCoordinate& c) {
    return c.process == active_index && c.parameter == parameter;
  });
  const auto k = static_cast<std::size_t>(found - coordinates.begin());
  const Interval log_interval = coordinate_interval(fit, k, method, rise_of(k));
  const double scale = parameter == 0 ? 0.5 : 1.0;
  Reported reported;
  const std::string name(process.kind->parameters[parameter].name);
  const bool bounded_below = std::isfinite(log_interval.low);
  const bool bounded_above = std::isfinite(log_interval.high);
  if (parameter == 0 && !bounded_below) {
    reported.reason =
        "Not identifiable: the data are compatible with no " + std::string(process.kind->title) + " at all.";
    reported.upper_limit = bounded_above ? std::exp(scale * log_interval.high) : kUnbounded;
    return reported;
  }
  if (parameter > 0 && !bounded_below && !bounded_above) {
    reported.reason = "Not identifiable: the data bound " + name + " on neither side.";
    return reported;
  }
  Estimate estimate;
  estimate.value = std::exp(scale * fit.best()(static_cast<Eigen::Index>(k)));
  estimate.ci95.low = bounded_below ? std::exp(scale * log_interval.low) : -kUnbounded;
  estimate.ci95.high = bounded_above ? std::exp(scale * log_interval.high) : kUnbounded;
  reported.estimate = estimate;
  return reported;
}

/// What y is taken to scatter with about a fit: S, the discrepancy of all candidates, and what the fit's own exceeds it
/// by.
BlockDiagonal scatter_about(const LogFit& fit, double discrepancy) {
  const WhitenedCurve& curve = fit.curve();
  const double more = std::max(0.0, discrepancy * discrepancy - curve.delta * curve.delta);
  return curve.scatter.raised(Eigen::VectorXd::Constant(curve.scatter.rows(), more));
}

std::vector<FittedProcess> report_with(Candidate& candidate, double unit, IntervalMethod method,
                                       const std::function<double(std::size_t)>& rise_of) {
  std::vector<FittedProcess> processes;
  std::size_t active_index = 0;
  for (const Process& process : candidate.fit.model) {
    FittedProcess fitted;
    fitted.kind = process.kind;
    const bool alive = process.parameters[0] > 0.0;
    bool level_known = alive;
    for (std::size_t k = 0; k < process.parameters.size(); ++k) {
      const ParameterSpec& spec = process.kind->parameters[k];
      FittedParameter parameter;
      parameter.declared = &spec;
      if (!alive) {
        parameter.reason = vanished(*process.kind);
      } else if (!level_known) {
        parameter.reason = "Not identifiable: the data do not show that the process is there.";
      } else {
        Reported reported = report_parameter(candidate, process, active_index, k, method, rise_of);
        level_known = k > 0 || reported.estimate.has_value();
        parameter.reason = std::move(reported.reason);
        parameter.estimate = reported.estimate;
        parameter.upper_limit = reported.upper_limit * (spec.channel_power != 0 ? unit : 1.0);
        if (parameter.estimate && spec.channel_power != 0) {
          parameter.estimate->value *= unit;
          parameter.estimate->ci95.low *= unit;
          parameter.estimate->ci95.high *= unit;
        }
      }
      fitted.parameters.push_back(std::move(parameter));
    }
    active_index += alive ? 1 : 0;
    processes.push_back(std::move(fitted));
  }
  return processes;
}

/// Names of the parameters whose bound is active, and a sentence for each shape at the end of its range.
void report_bounds(const Candidate& candidate, ModelFit& fit) {
  Model active;
  for (const Process& process : candidate.fit.model) {
    if (process.parameters[0] > 0.0) {
      active.push_back(process);
    } else {
      fit.bounds_active.push_back(std::string(process.kind->name) + "." +
                                  std::string(process.kind->parameters[0].name));
    }
  }
  for (const std::size_t k : candidate.log_fit->at_bound()) {
    const LogCoordinate& c = candidate.log_fit->coordinates()[k];
    const ProcessKind& kind = *active[c.process].kind;
    std::string name = std::string(kind.name) + "." + std::string(kind.parameters[c.parameter].name);
    if (c.parameter > 0) {
      const bool low = candidate.log_fit->best()(static_cast<Eigen::Index>(k)) <= c.low + 1e-6;
      fit.warnings.push_back(name + (low ? " lies at the low end of what a record of this length can tell."
                                         : " lies at the high end of what this sampling rate can tell."));
    }
    fit.bounds_active.push_back(std::move(name));
  }
}

/// `1.2 %`, with two digits.
std::string percent(double ratio) {
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), 100.0 * ratio, std::chars_format::general, 2);
  return std::string(text.data(), error == std::errc() ? end : text.data()) + " %";
}

}  // namespace

std::vector<FittedProcess> report_processes(Candidate& candidate, double unit, IntervalMethod method, double rise) {
  const LogFit& fit = *candidate.log_fit;
  const Eigen::VectorXd assumed = fit.sandwich();
  const Eigen::VectorXd actual = fit.sandwich(scatter_about(fit, own_discrepancy(candidate)));
  // An interval of L is widened as its curvature interval is: by the ratio of the two standard errors.
  return report_with(candidate, unit, method, [rise, assumed, actual](std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double ratio = actual(i) / assumed(i);
    return rise * std::max(1.0, ratio * ratio);
  });
}

std::vector<FittedProcess> report_processes(Candidate& candidate, double unit, const std::vector<double>& rises) {
  return report_with(candidate, unit, IntervalMethod::Profile, [&rises](std::size_t k) { return rises[k]; });
}

ModelFit report_fit(Candidate& candidate, double unit, double samples, IntervalMethod method,
                    const std::vector<double>& rises) {
  ModelFit fit;
  fit.model = model_name(candidate.structure);
  fit.objective = candidate.fit.objective;
  fit.wic = candidate.criterion(samples);
  fit.eq8 = candidate.eq8;
  fit.optimism = candidate.optimism;
  fit.parameters = candidate.parameters;
  fit.j_test = j_test(candidate);
  fit.described_within = own_discrepancy(candidate);
  fit.verdict = verdict_of(fit.j_test, fit.described_within);
  fit.intervals = !rises.empty() ? "bootstrap" : (method == IntervalMethod::Profile ? "profile" : "sandwich");
  fit.processes =
      rises.empty() ? report_processes(candidate, unit, method, kRise95) : report_processes(candidate, unit, rises);
  fit.condition_number = candidate.log_fit->condition_number();
  bool collapsed = false;
  bool unidentified = false;
  for (std::size_t p = 0; p < fit.processes.size(); ++p) {
    const bool gone = !(candidate.fit.model[p].parameters[0] > 0.0);
    collapsed = collapsed || gone;
    if (gone) {
      fit.warnings.push_back(fit.processes[p].parameters.front().reason);
      continue;
    }
    for (const FittedParameter& parameter : fit.processes[p].parameters) {
      if (!parameter.estimate) {
        unidentified = true;
        fit.warnings.push_back(std::string(fit.processes[p].kind->name) + "." + std::string(parameter.declared->name) +
                               ": " + parameter.reason);
      }
    }
  }
  fit.status = collapsed                 ? "collapsed"
               : unidentified            ? "unidentifiable"
               : candidate.fit.converged ? "converged"
                                         : "not_converged";
  report_bounds(candidate, fit);
  if (fit.condition_number > kPoorlyConditioned) {
    fit.warnings.emplace_back(
        "Some combination of the parameters is hardly known (condition number above 1e4): see their intervals.");
  }
  if (fit.described_within > 0.0) {
    fit.warnings.push_back("The model does not fit the wavelet variances (J-test p < 0.01): they are described to " +
                           std::string(fit.verdict == "described" ? "" : "no better than ") +
                           percent(fit.described_within) + ", and the intervals allow for that.");
  }
  return fit;
}

}  // namespace driftlab
