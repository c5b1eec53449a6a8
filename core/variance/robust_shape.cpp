#include "core/variance/robust_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::size_t kOrder = 2 * HaarCovariance::kEvenPowers;

/// Cumulants of (a - 2b + c)/sqrt 6, a, b, c uniform of variance 1, by order; odd ones vanish. Those of the uniform are
/// B_k/k 12^(k/2), B_k Bernoulli numbers; the sum has (2 + 2^k)/6^(k/2) of them.
std::array<double, kOrder + 1> cumulants(double share) {
  constexpr std::array<double, kOrder / 2 + 1> kBernoulli{
      1.0, 1.0 / 6.0, -1.0 / 30.0, 1.0 / 42.0, -1.0 / 30.0, 5.0 / 66.0, -691.0 / 2730.0, 7.0 / 6.0, -3617.0 / 510.0};
  std::array<double, kOrder + 1> kappa{};
  for (std::size_t k = 4; k <= kOrder; k += 2) {
    const auto order = static_cast<double>(k);
    kappa[k] = kBernoulli[k / 2] / order * std::pow(12.0, 0.5 * order) * (2.0 + std::exp2(order)) /
               std::pow(6.0, 0.5 * order) * std::pow(share, 0.5 * order);
  }
  return kappa;
}

}  // namespace

double mean_with_uniform_share(const Biweight& biweight, double uniform_share) {
  if (!(uniform_share > 0.0)) {
    return biweight.mean;
  }
  const auto kappa = cumulants(std::min(uniform_share, 1.0));
  // E He_n = sum_j C(n-1, j-1) kappa_j E He_{n-j}: the moments from the cumulants, without the Gaussian's.
  std::array<double, kOrder + 1> hermite{};
  hermite[0] = 1.0;
  for (std::size_t n = 4; n <= kOrder; n += 2) {
    double binomial = 1.0;  // C(n-1, j-1)
    for (std::size_t j = 1; j <= n; ++j) {
      hermite[n] += binomial * kappa[j] * hermite[n - j];
      binomial *= static_cast<double>(n - j) / static_cast<double>(j);
    }
  }
  double mean = biweight.mean;
  double factorial = 2.0;
  for (std::size_t k = 4; k <= kOrder; k += 2) {
    factorial *= static_cast<double>(k) * static_cast<double>(k - 1);
    mean += biweight.hermite[k / 2 - 1] * hermite[k] / std::sqrt(factorial);
  }
  return mean;
}

double quantization_share(const VarianceIntervals& intervals, const HaarCovariance& plan, std::size_t j) {
  const double total = intervals.modelled(static_cast<Eigen::Index>(j));
  double sum = 0.0;
  for (const Process& process : intervals.mixture) {
    sum += process.kind->symbol == "QN" ? process.haar_variance(plan.half()[j], plan.dt_s()) : 0.0;
  }
  return total > 0.0 ? sum / total : 0.0;
}

RobustShape quantization_shape(const VarianceIntervals& intervals, const HaarCovariance& plan, double excess) {
  RobustShape shape;
  const double first = quantization_share(intervals, plan, 0);
  if (!(excess < 0.5 * -0.6 * first * first) || !(first > 0.0)) {
    return shape;
  }
  for (std::size_t j = 0; j < plan.half().size(); ++j) {
    shape.uniform_share.push_back(quantization_share(intervals, plan, j));
  }
  return shape;
}

}  // namespace driftlab
