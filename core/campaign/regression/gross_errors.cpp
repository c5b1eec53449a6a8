#include "core/campaign/regression/gross_errors.hpp"

#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::regression {
namespace {

/// Chi-square of equal rates within the arm and its degrees of freedom, added to the arguments.
void add_scatter(const ErrorCounts& counts, double& chi_square, double& dof) {
  const double sum = counts.sum();
  for (std::size_t s = 0; sum > 0.0 && s < counts.errors.size(); ++s) {
    const double expected = sum * counts.hours[s] / counts.time_h();
    chi_square += (counts.errors[s] - expected) * (counts.errors[s] - expected) / expected;
  }
  dof += sum > 0.0 ? static_cast<double>(counts.errors.size()) - 1.0 : 0.0;
}

}  // namespace

double ErrorCounts::sum() const { return std::accumulate(errors.begin(), errors.end(), 0.0); }
double ErrorCounts::time_h() const { return std::accumulate(hours.begin(), hours.end(), 0.0); }

double error_rate_p(const ErrorCounts& baseline, const ErrorCounts& candidate, double times) {
  double chi_square = 8.0;  // four degrees of freedom at 2
  double dof = 4.0;
  add_scatter(baseline, chi_square, dof);
  add_scatter(candidate, chi_square, dof);
  const double scatter = std::max(1.0, chi_square / dof);
  const double odds = times * candidate.time_h() / baseline.time_h();
  return beta_probability(odds / (1.0 + odds), candidate.sum() / scatter + 0.5, baseline.sum() / scatter + 0.5);
}

double beta_probability(double x, double a, double b) {
  if (!(x > 0.0)) {
    return 0.0;
  }
  if (x >= 1.0) {
    return 1.0;
  }
  if (x > (a + 1.0) / (a + b + 2.0)) {
    return 1.0 - beta_probability(1.0 - x, b, a);
  }
  constexpr double kTiny = 1e-300;
  const double front =
      std::exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
  double c = 1.0;
  double d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
  double fraction = d;
  for (int m = 1; m <= 10000; ++m) {
    double step = 1.0;
    for (const bool odd : {false, true}) {
      const double i = m;
      const double term = odd ? -(a + i) * (a + b + i) * x / ((a + 2.0 * i) * (a + 2.0 * i + 1.0))
                              : i * (b - i) * x / ((a + 2.0 * i - 1.0) * (a + 2.0 * i));
      d = 1.0 + term * d;
      d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1.0 + term / c;
      c = std::abs(c) < kTiny ? kTiny : c;
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1.0) < 1e-14) {
      break;
    }
  }
  return std::clamp(front * fraction, 0.0, 1.0);
}

}  // namespace driftlab::regression
