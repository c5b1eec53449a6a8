#include "core/fit/channel_variances.hpp"

#include "core/fit/sample_wise_variance.hpp"
#include "core/variance/contamination.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/lattice.hpp"
#include "core/variance/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab {
namespace {

/// Events among flagged grid points (ascending): those within a second of the one before belong to its event.
std::size_t count_bursts(const std::vector<std::size_t>& flagged, double dt_s) {
  constexpr double kApart = 1.0;  // [s]
  std::size_t bursts = 0;
  for (std::size_t i = 0; i < flagged.size(); ++i) {
    bursts += i == 0 || static_cast<double>(flagged[i] - flagged[i - 1]) * dt_s > kApart ? 1 : 0;
  }
  return bursts;
}

void take_sample_wise(SampleWiseVariance found, double unit_square, const VarianceIntervals& intervals,
                      HaarCovariance& plan, RobustVariances& result) {
  HaarVariance curve = std::move(found.curve);
  for (double& variance : curve.variance) {
    variance /= unit_square;
  }
  VarianceIntervals own = intervals;
  if (*std::max_element(curve.variance.begin(), curve.variance.end()) > 0.0) {
    own = variance_intervals(curve, plan);
  }
  lower_degrees(found.efficiency, curve, own);
  result.sample_wise = true;
  result.variance.assign(curve.variance.begin(), curve.variance.end());
  result.ci95 = std::move(own.ci95);
  result.efficiency = std::move(found.efficiency);
  result.contamination.flagged_samples = found.flagged.size();
  result.contamination.bursts = count_bursts(found.flagged, plan.dt_s());
}

}  // namespace

RobustShape clean_shape(std::span<const double> samples, double unit_square, const VarianceIntervals& intervals,
                        HaarCovariance& plan, std::uint64_t seed, const RunControl& control) {
  RobustShape shape = lattice_shape(samples, unit_square, intervals, plan, seed, control);
  if (!shape.refused && !shape.simulated(0)) {
    shape = quantization_shape(intervals, plan, difference_excess_kurtosis(samples, control));
  }
  return shape;
}

void lower_degrees(const std::vector<double>& efficiency, const HaarVariance& curve, VarianceIntervals& intervals) {
  for (std::size_t j = 0; j < efficiency.size(); ++j) {
    intervals.edf[j] *= efficiency[j];
    intervals.estimate_variance(static_cast<Eigen::Index>(j)) /= efficiency[j];
    intervals.ci95[j] = chi_square_interval(curve.variance[j], intervals.edf[j]);
  }
}

Result<ClassicalVariances> classical_variances(std::span<const double> rows, double mean, const GappySamples& grid,
                                               double dt_s, std::uint64_t seed, const RunControl& control) {
  ClassicalVariances result;
  if (grid.missing.empty()) {
    result.curve = haar_variance(rows, mean, control);
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The characterisation was cancelled.");
    }
  } else {
    std::vector<std::size_t> half;
    for (std::size_t m = 1; 2 * m <= grid.size(); m *= 2) {
      half.push_back(m);
    }
    HaarCovariance plan(half, grid.size(), dt_s);
    SampleWiseVariance found = sample_wise_variance(grid, plan, {.seed = seed, .look_for_errors = false}, control);
    if (found.outcome == SampleWiseOutcome::Cancelled) {
      return fail(ErrorCode::Cancelled, "The characterisation was cancelled.");
    }
    if (found.outcome != SampleWiseOutcome::Estimated) {
      return fail(ErrorCode::TooFewSamples,
                  "The gaps leave too few samples, or too many equal ones, to say what is missing.",
                  {{"samples", std::to_string(rows.size())}});
    }
    result.curve = std::move(found.curve);
    result.efficiency = std::move(found.efficiency);
    result.completed = std::move(found.completed);
  }
  result.unit_square = *std::max_element(result.curve.variance.begin(), result.curve.variance.end());
  return result;
}

RobustVariances robust_variances(std::span<const double> samples, double mean, const GappySamples& grid,
                                 const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                 HaarCovariance& plan, std::uint64_t seed, const RunControl& control) {
  const HaarVariance& curve = classical.curve;
  const double unit_square = classical.unit_square;
  RobustVariances result;
  RobustVariance coefficients =
      robust_variance(samples, mean, curve, intervals, plan,
                      clean_shape(samples, unit_square, intervals, plan, seed, control), control);
  if (control.stop.stop_requested()) {
    return result;
  }
  for (std::size_t j = 0; j < curve.scales(); ++j) {  // the robust equation was solved in the samples' units
    if (std::optional<double>& value = coefficients.variance[j]) {
      *value /= unit_square;
      coefficients.ci95[j] = {coefficients.ci95[j].low / unit_square, coefficients.ci95[j].high / unit_square};
    }
  }
  const ContaminationTest test = test_contamination(samples, unit_square, curve, intervals, coefficients, plan);
  result.variance = std::move(coefficients.variance);
  result.ci95 = std::move(coefficients.ci95);
  result.efficiency = std::move(coefficients.efficiency);
  result.contamination = {.verdict = std::string(name_of(test.verdict)),
                          .p = test.p,
                          .disjoint_scales = test.disjoint_scales,
                          .flagged_samples = test.flagged_coefficients,
                          .bursts = std::nullopt,
                          .not_gaussian = test.not_gaussian};
  if (coefficients.shape.refused) {
    result.warnings.emplace_back(
        "The samples lie on a lattice coarser than their noise: no robust variance can be given, and gross errors can "
        "not be told from clean data.");
    return result;
  }
  if (test.verdict == ContaminationVerdict::Clean) {
    return result;
  }
  const GappySamples whole = grid.missing.empty() ? GappySamples{{samples.begin(), samples.end()}, {}} : GappySamples{};
  SampleWiseVariance found = sample_wise_variance(grid.missing.empty() ? whole : grid, plan, {.seed = seed}, control);
  if (found.outcome == SampleWiseOutcome::NotGaussian) {
    result.contamination.not_gaussian = true;
    result.contamination.verdict = name_of(ContaminationVerdict::Undecided);
    result.warnings.emplace_back(
        "More than a fifth of the samples deviate from a Gaussian core: the noise has another shape, and there is no "
        "truth for a robust variance to find.");
  } else if (found.outcome == SampleWiseOutcome::Estimated && !found.flagged.empty()) {
    take_sample_wise(std::move(found), unit_square, intervals, plan, result);
  }
  return result;
}

Eigen::MatrixXd FittedVariances::covariance(HaarCovariance& plan, const Model& model) const {
  Eigen::VectorXd raise = Eigen::VectorXd::Ones(sd.size());
  for (std::size_t j = 0; j < efficiency.size(); ++j) {
    raise(static_cast<Eigen::Index>(j)) = 1.0 / std::sqrt(efficiency[j]);
  }
  Eigen::MatrixXd covariance = plan.matrix(model);
  add_kurtosis(covariance, model, plan.half(), plan.samples(), plan.dt_s(), shape);
  scatter.apply(covariance);
  return raise.asDiagonal() * covariance * raise.asDiagonal();
}

FittedVariances fitted_variances(const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                 const RobustVariances& robust, HaarCovariance& plan) {
  FittedVariances fitted{classical.curve.variance, intervals.estimate_variance.cwiseSqrt(),
                         classical.efficiency,     intervals.shape,
                         intervals.mixture,        false,
                         intervals.scatter};
  if (!robust.sample_wise || robust.contamination.verdict != name_of(ContaminationVerdict::Contaminated)) {
    return fitted;
  }
  HaarVariance curve = classical.curve;
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    curve.variance[j] = robust.variance[j].value_or(0.0);
  }
  if (!(*std::max_element(curve.variance.begin(), curve.variance.end()) > 0.0)) {
    return fitted;
  }
  VarianceIntervals own = variance_intervals(curve, plan);
  lower_degrees(robust.efficiency, curve, own);
  fitted.variance = std::move(curve.variance);
  fitted.sd = own.estimate_variance.cwiseSqrt();
  fitted.efficiency = robust.efficiency;
  fitted.shape = own.shape;
  fitted.scatter = {};
  fitted.mixture = std::move(own.mixture);
  fitted.robust = true;
  return fitted;
}

}  // namespace driftlab
