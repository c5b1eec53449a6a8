#include "core/fit/j_test.hpp"

#include "core/process/distributions.hpp"

#include <algorithm>

namespace driftlab {
namespace {

/// The longest two scales scatter less than the chi-squares they are taken for where they have few degrees of freedom:
/// the distance falls short of its own by about 1.15 on average in models of noise, and by nothing where a drift rules
/// those scales and makes their variance regular. The size of the test so corrected: column J of tests/ACCURACY.md.
double shortfall(double longest_edf) {
  constexpr double kShort = 1.15;
  return kShort * std::clamp((6.0 - longest_edf) / 4.0, 0.0, 1.0);
}

/// A scale with fewer degrees of freedom takes no part in the test.
constexpr double kOneDegree = 1.2;

}  // namespace

double j_statistic(const LogFit& fit) {
  Eigen::VectorXd whitened;
  fit.evaluate(fit.best(), &whitened, nullptr);
  // The whitening is lower triangular: without its last entries the sum of squares is that of the rows before.
  const Eigen::VectorXd& edf = fit.curve().curve.edf;
  double sum = 0.0;
  for (Eigen::Index j = 0; j < whitened.size(); ++j) {
    sum += edf(j) >= kOneDegree ? whitened(j) * whitened(j) : 0.0;
  }
  return sum;
}

double distance_dof(const Candidate& candidate) {
  const auto rows = static_cast<double>(candidate.log_fit->scales());
  return std::max(1.0, rows - static_cast<double>(candidate.parameters));
}

std::optional<JTest> j_test(const Candidate& candidate) {
  double rows = 0.0;
  double longest = 0.0;
  for (const double edf : candidate.log_fit->curve().curve.edf) {
    rows += edf >= kOneDegree ? 1.0 : 0.0;
    longest = edf >= kOneDegree ? edf : longest;
  }
  const double over = rows - static_cast<double>(candidate.test_parameters);
  if (over < 2.0) {
    return std::nullopt;
  }
  const double dof = over - shortfall(longest);
  return JTest{candidate.test_distance, dof, chi_squared_tail(candidate.test_distance, dof)};
}

double own_discrepancy(const Candidate& candidate) {
  const std::optional<JTest> test = j_test(candidate);
  if (!test || stands_at(test->p)) {
    return 0.0;
  }
  const double common = candidate.log_fit->curve().delta;
  if (common > 0.0 && chi_squared_tail(candidate.log_fit->minimum(), distance_dof(candidate)) >= kRejected) {
    return common;
  }
  return discrepancy_of(candidate.log_fit->residual(), candidate.log_fit->curve().curve.covariance,
                        distance_dof(candidate));
}

std::string verdict_of(const std::optional<JTest>& test, double discrepancy) {
  if (!test) {
    return "untested";
  }
  if (stands_at(test->p)) {
    return "accepted";
  }
  return discrepancy <= kDescribed ? "described" : "not_described";
}

}  // namespace driftlab
