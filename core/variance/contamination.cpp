#include "core/variance/contamination.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr double kEnoughDegrees = 90.0;
constexpr double kClean = 0.05;
constexpr double kContaminated = 0.01;
constexpr double kGross = 4.5;
constexpr double kCarried = 0.4;
constexpr double kFew = 0.1;

/// Fills in who carries the excess at the first scale; true if it is a few.
bool look_at_first_scale(std::span<const double> samples, double unit_square, const HaarVariance& curve,
                         const RobustVariance& robust, ContaminationTest& test) {
  const std::optional<double>& first = robust.variance.front();
  if (!first || samples.size() < 2) {
    return false;
  }
  const double core = *first;
  const double limit = kGross * kGross * core * unit_square;
  double kept = 0.0;
  for (std::size_t t = 1; t < samples.size(); ++t) {
    const double w = 0.5 * (samples[t] - samples[t - 1]);
    if (w * w > limit) {
      ++test.flagged_coefficients;
    } else {
      kept += w * w / unit_square;
    }
  }
  const auto count = static_cast<double>(samples.size() - 1);
  const double excess = curve.variance.front() - core;
  if (!(excess > 0.0)) {
    return false;
  }
  test.excess_carried = std::clamp((curve.variance.front() - kept / count) / excess, 0.0, 1.0);
  return test.excess_carried >= kCarried && static_cast<double>(test.flagged_coefficients) <= kFew * count;
}

}  // namespace

std::string_view name_of(ContaminationVerdict verdict) {
  switch (verdict) {
    case ContaminationVerdict::Clean:
      return "clean";
    case ContaminationVerdict::Contaminated:
      return "contaminated";
    case ContaminationVerdict::Undecided:
      return "undecided";
  }
  return "undecided";
}

ContaminationTest test_contamination(std::span<const double> samples, double unit_square, const HaarVariance& curve,
                                     const VarianceIntervals& classical, const RobustVariance& robust,
                                     HaarCovariance& plan) {
  ContaminationTest test;
  std::vector<std::size_t> used;
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    if (robust.variance[j] && curve.variance[j] > 0.0) {
      if (robust.ci95[j].low > classical.ci95[j].high || robust.ci95[j].high < classical.ci95[j].low) {
        test.disjoint_scales.push_back(2 * curve.half[j]);
      }
    }
    if (classical.edf[j] < kEnoughDegrees || !(curve.variance[j] > 0.0)) {
      continue;
    }
    if (robust.variance[j]) {
      used.push_back(j);
    } else {
      test.undefined_scales.push_back(2 * curve.half[j]);
    }
  }
  if (used.empty()) {
    return test;
  }
  const bool few_carry = look_at_first_scale(samples, unit_square, curve, robust, test);
  const auto count = static_cast<Eigen::Index>(used.size());
  Eigen::VectorXd d(count);
  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index b = 0; b < count; ++b) {
    const std::size_t j = used[static_cast<std::size_t>(b)];
    d(b) = std::log(robust.variance[j].value_or(curve.variance[j]) / curve.variance[j]);
    for (Eigen::Index a = 0; a <= b; ++a) {
      const std::size_t i = used[static_cast<std::size_t>(a)];
      auto sums = plan.correlation_sums(i, j, classical.mixture);
      double sum = 0.0;
      if (i == j && robust.stride[j] > 1) {
        const double all = sums[0];
        sums = plan.thinned_sums(j, robust.stride[j], classical.mixture);
        sum = std::max(0.0, sums[0] - all) * robust.biweight[j].hermite[0] * robust.biweight[j].hermite[0];
      }
      for (std::size_t k = 1; k < sums.size(); ++k) {
        sum += robust.biweight[i].hermite[k] * robust.biweight[j].hermite[k] * sums[k];
      }
      sum *= std::sqrt(robust.shape.inflation_at(i) * robust.shape.inflation_at(j));
      covariance(a, b) = 2.0 * sum / (robust.biweight[i].hermite[0] * robust.biweight[j].hermite[0]);
      covariance(b, a) = covariance(a, b);
    }
  }
  test.dof = static_cast<double>(count);
  test.statistic = std::max(0.0, d.dot(solve_symmetric(covariance, d)));
  const double capped = std::min(test.statistic, 1e6);
  test.p = chi_squared_tail(capped, test.dof);
  if (!test.undefined_scales.empty()) {
    test.p = 0.0;
  }
  if (test.p >= kClean) {
    test.verdict = ContaminationVerdict::Clean;
  } else if (test.p < kContaminated && few_carry) {
    test.verdict = ContaminationVerdict::Contaminated;
  } else {
    test.not_gaussian = test.p < kContaminated;
  }
  return test;
}

}  // namespace driftlab
