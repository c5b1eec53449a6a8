#include "core/fit/curve_description.hpp"

#include "core/fit/composite_kinds.hpp"
#include "core/fit/composite_search.hpp"
#include "core/fit/ieee952_coefficients.hpp"
#include "core/variance/allan_variance.hpp"
#include "core/variance/spectral_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace driftlab {
namespace {

constexpr std::size_t kFewestScales = 5;
/// Standard error of the logarithm of a parameter beyond which it is not identified.
constexpr double kUnknown = 1.0;

std::string brief(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

/// Variances and half lengths of the curve that is to be described.
struct Scales {
  std::vector<std::size_t> half;
  CompositeCurve curve;
};

Scales scales_of(const DescribedSamples& channel, const FittedVariances& octaves, const RunControl& control) {
  Scales scales;
  scales.curve.shape = octaves.shape;
  std::vector<double> variance;
  std::vector<double> raise;
  if (octaves.robust || channel.gaps) {
    for (std::size_t j = 0; j < channel.half.size() && 4 * channel.half[j] <= channel.samples.size(); ++j) {
      scales.half.push_back(channel.half[j]);
      variance.push_back(octaves.variance[j]);
      raise.push_back(octaves.efficiency.empty() ? 1.0 : 1.0 / std::sqrt(octaves.efficiency[j]));
    }
    scales.curve.raise = Eigen::Map<const Eigen::VectorXd>(raise.data(), static_cast<Eigen::Index>(raise.size()));
  } else {
    scales.half = dense_half_lengths(channel.samples.size());
    variance = allan_variance(channel.samples, channel.mean, scales.half, control);
    for (double& one : variance) {
      one *= 0.5 / channel.unit_square;
    }
  }
  scales.curve.variance =
      Eigen::Map<const Eigen::VectorXd>(variance.data(), static_cast<Eigen::Index>(variance.size()));
  return scales;
}

std::vector<FittedProcess> told_processes(const CompositeBasis& basis, const CompositeSearchResult& found,
                                          double unit) {
  const Composite& model = found.fits.front().model;
  const Eigen::VectorXd errors = CompositeDistance(basis, found.curve, found.delta).standard_errors(model);
  std::vector<FittedProcess> processes;
  Eigen::Index k = 0;
  for (const Component& component : model) {
    const Process values = basis.process(component);
    FittedProcess& process = processes.emplace_back(FittedProcess{values.kind, {}});
    for (std::size_t i = 0; i < values.parameters.size(); ++i, ++k) {
      const ParameterSpec& spec = values.kind->parameters[i];
      const double value = values.parameters[i] * (i == 0 ? unit : 1.0);
      const double half = 1.96 * errors(k) * (i == 0 ? 0.5 : 1.0) + (i == 0 ? 0.5 * found.delta : 0.0);
      FittedParameter& told = process.parameters.emplace_back(FittedParameter{&spec, std::nullopt, {}});
      if (errors(k) < kUnknown) {
        told.estimate = Estimate{value, {value * std::exp(-half), value * std::exp(half)}};
      } else {
        told.reason = "The curve does not determine it.";
      }
    }
  }
  return processes;
}

/// What a model holds beside white noise, random walks and slow processes, as people say it.
std::string beyond_candidates(const CompositeBasis& basis, const Composite& model, double dt_s) {
  std::string text;
  for (const Component& component : model) {
    if (const auto shown = basis.process(component).appearance(dt_s)) {
      text += text.empty() ? "" : ", ";
      text += shown->before;
      text += shown->figure ? brief(*shown->figure) : "";
      text += shown->after;
    }
  }
  return text;
}

std::string sentence_of(const CurveDescription& description, const std::string& beyond) {
  if (description.verdict == "not_described") {
    return "No sum of the known processes describes the curve within 10 %; " + description.model + " comes nearest.";
  }
  const std::string how =
      description.verdict == "accepted" ? "" : " to " + brief(100.0 * description.discrepancy) + " % of the variances";
  if (!beyond.empty()) {
    return "The curve shows " + beyond + ": " + description.model + " describes it" + how + ".";
  }
  return how.empty() ? "" : "No model is accepted; " + description.model + " describes the curve" + how + ".";
}

}  // namespace

void describe_curve(const DescribedSamples& channel, const FittedVariances& octaves, const RunControl& control,
                    ChannelCharacterisation& result) {
  AllanParameters& coefficients = result.allan_parameters;
  Scales scales = scales_of(channel, octaves, control);
  if (scales.half.size() < kFewestScales || control.stop.stop_requested()) {
    coefficients.q_reason = coefficients.n_reason = coefficients.b_reason = coefficients.k_reason =
        coefficients.r_reason = "The record is too short: fewer scales than terms.";
    return;
  }
  scales.curve.lines = [&] { return spectral_lines(channel.samples, channel.mean, 4, control); };
  const std::shared_ptr<const CompositeBasis> basis =
      composite_basis(scales.half, channel.samples.size(), channel.dt_s);
  const CompositeSearchResult found = search_composite(*basis, scales.curve, control);
  if (control.stop.stop_requested()) {
    return;
  }
  const double unit = channel.unit * std::sqrt(channel.unit_square);
  coefficients = ieee952_coefficients(*basis, found, unit);
  if (found.fits.empty()) {
    return;
  }
  const CompositeFit& best = found.fits.front();
  CurveDescription& description = result.description.emplace();
  description.model = composite_name(*basis, best.model);
  description.verdict = found.accepted ? "accepted" : found.delta > 0.0 ? "described" : "not_described";
  description.discrepancy = std::max(found.delta, 0.0);
  description.p = best.p;
  description.parameters = best.parameters;
  description.scales = scales.half.size();
  description.processes = told_processes(*basis, found, unit);
  for (std::size_t i = 1; i < found.fits.size(); ++i) {
    std::string name = composite_name(*basis, found.fits[i].model);
    if (name != description.model &&
        std::ranges::find(description.alternatives, name) == description.alternatives.end()) {
      description.alternatives.push_back(std::move(name));
    }
  }
  description.sentence = sentence_of(description, beyond_candidates(*basis, best.model, channel.dt_s));
}

}  // namespace driftlab
