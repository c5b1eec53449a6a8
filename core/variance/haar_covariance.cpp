#include "core/variance/haar_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// Lags from 0 to `last`: every kink of gamma is one, and between them the step is the larger of mi/16 and 6 % of the
/// distance to the nearest kink.
std::vector<double> choose_lags(double mi, double mj, double last) {
  // Quantization noise has spikes of one lag there: the neighbours of a kink are taken too, so that it has the
  // weight 1.
  std::vector<double> kinks{last};
  for (const double kink : {0.0, mi, mj - mi, mj, mj + mi}) {
    for (const double lag : {kink - 1.0, kink, kink + 1.0}) {
      kinks.push_back(std::clamp(lag, 0.0, last));
    }
  }
  std::sort(kinks.begin(), kinks.end());
  kinks.erase(std::unique(kinks.begin(), kinks.end()), kinks.end());
  const double fine = std::max(1.0, std::floor(mi / 16.0));
  std::vector<double> lags{0.0};
  for (std::size_t k = 1; k < kinks.size(); ++k) {
    const double start = kinks[k - 1];
    const double end = kinks[k];
    const bool open_end = k + 1 == kinks.size() && end > mi + mj;  // the last lag is no kink
    while (lags.back() < end) {
      const double here = lags.back();
      const double gap = open_end ? here - (mi + mj) : std::min(here - start, end - here);
      const double grown = gap > 2.0 * mi ? std::floor(0.06 * gap) : 0.0;
      lags.push_back(std::min(end, here + std::max(fine, grown)));
    }
  }
  return lags;
}

}  // namespace

HaarCovariance::HaarCovariance(std::span<const std::size_t> half, std::size_t samples, double dt_s)
    : half_(half.begin(), half.end()), samples_(static_cast<double>(samples)), dt_s_(dt_s) {
  pairs_.resize(half_.size() * (half_.size() + 1) / 2);
}

HaarCovariance::Pair& HaarCovariance::pair(std::size_t i, std::size_t j) {
  Pair& plan = pairs_[j * (j + 1) / 2 + i];
  if (!plan.lag.empty()) {
    return plan;
  }
  const double mi = half_[i];
  const double mj = half_[j];
  const double n = samples_;
  const double last = n - mi - mj;
  const double count = (n - 2.0 * mi + 1.0) * (n - 2.0 * mj + 1.0);
  plan.lag = choose_lags(mi, mj, last);
  plan.weight.resize(plan.lag.size());
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    // sum_{h=-last}^{last} f = 2 trapezoid + f(last)
    const double before = k > 0 ? plan.lag[k] - plan.lag[k - 1] : 0.0;
    const double after = k + 1 < plan.lag.size() ? plan.lag[k + 1] - plan.lag[k] : 0.0;
    const double width = before + after + (k + 1 == plan.lag.size() ? 1.0 : 0.0);
    const double overlap = std::min(n - mj, n - mi - plan.lag[k]) - mj + 1.0;
    plan.weight[k] = width * overlap / count;
  }
  return plan;
}

HaarCovariance::Pair& HaarCovariance::fill(std::size_t i, std::size_t j, const Model& model, bool remember_shapes) {
  Pair& plan = pair(i, j);
  const std::size_t size = plan.lag.size();
  scratch_.assign(size, 0.0);
  for (const Process& process : model) {
    const ProcessKind& kind = *process.kind;
    if (kind.has_shape() && !remember_shapes) {
      kind.add_haar_cross(process.parameters, half_[i], half_[j], dt_s_, plan.lag, 1.0, scratch_);
      continue;
    }
    std::vector<double>& unit = plan.unit[{&kind, kind.has_shape() ? process.parameters[1] : 0.0}];
    if (unit.empty()) {
      unit.assign(size, 0.0);
      std::vector<double> at_level_one = process.parameters;
      at_level_one[0] = 1.0;
      kind.add_haar_cross(at_level_one, half_[i], half_[j], dt_s_, plan.lag, 1.0, unit);
    }
    const double level = process.parameters[0] * process.parameters[0];
    for (std::size_t k = 0; k < size; ++k) {
      scratch_[k] += level * unit[k];
    }
  }
  return plan;
}

double HaarCovariance::entry(std::size_t i, std::size_t j, const Model& model, bool remember_shapes) {
  const Pair& plan = fill(i, j, model, remember_shapes);
  double mean_i = 0.0;
  double mean_j = 0.0;
  for (const Process& process : model) {
    mean_i += process.haar_mean(half_[i], dt_s_);
    mean_j += process.haar_mean(half_[j], dt_s_);
  }
  double squares = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    squares += plan.weight[k] * scratch_[k] * scratch_[k];
    sum += plan.weight[k] * scratch_[k];
  }
  // A deterministic curve would have no variance at all; its rounding is some 10^-8 of it.
  const double rounding = i == j ? 1e-16 * std::pow(haar_variance(model, half_[i], dt_s_), 2.0) : 0.0;
  return 2.0 * squares + 4.0 * mean_i * mean_j * sum + rounding;
}

std::array<double, HaarCovariance::kEvenPowers> HaarCovariance::correlation_sums(std::size_t i, std::size_t j,
                                                                                 const Model& model) {
  std::array<double, kEvenPowers> sums{};
  const auto variance = [&](double half) {
    double sum = 0.0;
    for (const Process& process : model) {
      if (process.haar_mean(half, dt_s_) == 0.0) {
        sum += process.haar_variance(half, dt_s_);
      }
    }
    return sum;
  };
  const double scale = std::sqrt(variance(half_[i]) * variance(half_[j]));
  if (!(scale > 0.0)) {
    return sums;
  }
  const Pair& plan = fill(i, j, model, true);
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    const double rho = scratch_[k] / scale;
    double power = plan.weight[k];
    for (double& sum : sums) {
      power *= rho * rho;
      sum += power;
    }
  }
  return sums;
}

Eigen::MatrixXd HaarCovariance::matrix(const Model& model) {
  const auto scales = static_cast<Eigen::Index>(half_.size());
  Eigen::MatrixXd covariance(scales, scales);
  for (Eigen::Index j = 0; j < scales; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      covariance(i, j) = entry(static_cast<std::size_t>(i), static_cast<std::size_t>(j), model, false);
      covariance(j, i) = covariance(i, j);
    }
  }
  return covariance;
}

Eigen::VectorXd HaarCovariance::diagonal(const Model& model) {
  const auto scales = static_cast<Eigen::Index>(half_.size());
  Eigen::VectorXd variances(scales);
  for (Eigen::Index j = 0; j < scales; ++j) {
    variances(j) = entry(static_cast<std::size_t>(j), static_cast<std::size_t>(j), model, true);
  }
  return variances;
}

}  // namespace driftlab
