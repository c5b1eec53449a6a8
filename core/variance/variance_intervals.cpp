#include "core/variance/variance_intervals.hpp"

#include "core/process/distributions.hpp"
#include "core/process/registry.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/nonnegative_least_squares.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// Dictionary processes at level 1; shapes from the registry names.
Model dictionary(double samples, double dt_s, bool with_drift) {
  Model entries;
  for (const char* symbol : {"QN", "WN", "FN", "RW"}) {
    entries.push_back({find_process(symbol), {1.0}});
  }
  for (int quarter = 0; std::ldexp(2.0, -2 * quarter) > 0.5 / samples; ++quarter) {
    entries.push_back({find_process("GM"), {1.0, std::ldexp(2.0, -2 * quarter) / dt_s}});
  }
  if (with_drift) {
    entries.push_back({find_process("DR"), {1.0}});
  }
  return entries;
}

struct MixtureFit {
  Model mixture;
  Eigen::VectorXd modelled;
  Eigen::VectorXd variance;
  double deviance = 0.0;
};

MixtureFit fit_mixture(const Eigen::VectorXd& nu, HaarCovariance& plan, bool with_drift) {
  const auto half = plan.half();
  const double samples = static_cast<double>(plan.samples());
  const Model entries = dictionary(samples, plan.dt_s(), with_drift);
  const Eigen::Index scales = nu.size();
  Eigen::MatrixXd design(scales, static_cast<Eigen::Index>(entries.size()));
  for (Eigen::Index j = 0; j < scales; ++j) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      design(j, static_cast<Eigen::Index>(k)) =
          entries[k].haar_variance(half[static_cast<std::size_t>(j)], plan.dt_s());
    }
  }
  MixtureFit fit;
  Eigen::VectorXd sd(scales);
  for (Eigen::Index j = 0; j < scales; ++j) {  // before any model: as if every 2m samples were one degree of freedom
    const double level = std::max(nu(j), 1e-12 * nu.maxCoeff());
    sd(j) = level * std::sqrt(2.0 * std::max(1.0, 2.0 * half[static_cast<std::size_t>(j)] / samples * 1.5) /
                              std::max(1.0, samples / (2.0 * half[static_cast<std::size_t>(j)])));
  }
  for (int round = 0; round < 4; ++round) {
    const Eigen::VectorXd weight = sd.cwiseInverse();
    const NonnegativeSolution solution =
        nonnegative_least_squares(weight.asDiagonal() * design, weight.cwiseProduct(nu));
    fit.mixture.clear();
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const double square = solution.x(static_cast<Eigen::Index>(k));
      if (square > 0.0) {
        Process process = entries[k];
        process.parameters[0] = std::sqrt(square);
        fit.mixture.push_back(std::move(process));
      }
    }
    fit.modelled = design * solution.x;
    fit.variance = plan.diagonal(fit.mixture);
    sd = fit.variance.cwiseSqrt();
    const double floor = 1e-12 * sd.maxCoeff();
    sd = sd.cwiseMax(floor > 0.0 ? floor : 1.0);
  }
  for (Eigen::Index j = 0; j < scales; ++j) {
    const double edf = 2.0 * fit.modelled(j) * fit.modelled(j) / fit.variance(j);
    const double ratio = std::max(nu(j) / fit.modelled(j), 1e-12);
    fit.deviance += edf * (ratio - std::log(ratio) - 1.0) - std::log(edf);
  }
  return fit;
}

void widen_by_kurtosis(VarianceIntervals& intervals, const HaarVariance& curve, const HaarCovariance& plan,
                       double excess) {
  const double rough = part_variance(intervals.mixture, 1.0, plan.dt_s(), true);
  const double share = rough / intervals.modelled(0);
  const bool use_rough = share >= 0.5;
  // First differences of independent values halve the excess; those of a random walk are its innovations.
  const double own = use_rough ? 2.0 * excess / (share * share) : excess / ((1.0 - share) * (1.0 - share));
  const double kurtosis = std::max(own, -2.0);  // no distribution has less
  intervals.shape = {kurtosis, use_rough};
  for (Eigen::Index j = 0; j < intervals.modelled.size(); ++j) {
    const std::size_t half = curve.half[static_cast<std::size_t>(j)];
    const double part = part_variance(intervals.mixture, static_cast<double>(half), plan.dt_s(), use_rough);
    const double added = kurtosis * part * part * kurtosis_share(half, curve.samples);
    intervals.estimate_variance(j) =
        std::max(intervals.estimate_variance(j) + added, 0.05 * intervals.estimate_variance(j));
  }
}

constexpr double kDriftEvidence = 20.0;
constexpr double kManyDegrees = 1e4;

}  // namespace

Interval chi_square_interval(double variance, double edf) {
  if (!(variance > 0.0) || !(edf > 0.0)) {
    return {0.0, 0.0};
  }
  if (edf > kManyDegrees) {  // Wilson and Hilferty (1931); its error falls as edf^-1.5 and is below 1e-7 here
    const auto quantile = [edf](double z) {
      const double root = 1.0 - 2.0 / (9.0 * edf) + z * std::sqrt(2.0 / (9.0 * edf));
      return root * root * root;
    };
    return {variance / quantile(kNormal975), variance / quantile(-kNormal975)};
  }
  // Below half a degree of freedom the quantiles underflow; the upper limit is then as good as open.
  const double dof = std::max(edf, 0.5);
  return {variance * dof / chi_squared_quantile(0.975, dof), variance * dof / chi_squared_quantile(0.025, dof)};
}

VarianceIntervals variance_intervals(const HaarVariance& curve, HaarCovariance& plan, double excess) {
  const Eigen::VectorXd nu =
      Eigen::Map<const Eigen::VectorXd>(curve.variance.data(), static_cast<Eigen::Index>(curve.variance.size()));
  MixtureFit fit = fit_mixture(nu, plan, false);
  MixtureFit drifting = fit_mixture(nu, plan, true);
  if (!(drifting.deviance >= fit.deviance - kDriftEvidence) || !std::isfinite(fit.deviance)) {
    fit = std::move(drifting);
  }
  VarianceIntervals result;
  result.mixture = std::move(fit.mixture);
  result.modelled = fit.modelled;
  result.estimate_variance = fit.variance;
  if (excess != 0.0) {
    widen_by_kurtosis(result, curve, plan, excess);
  }
  for (Eigen::Index j = 0; j < nu.size(); ++j) {
    const double edf = 2.0 * result.modelled(j) * result.modelled(j) / result.estimate_variance(j);
    result.edf.push_back(edf);
    result.ci95.push_back(chi_square_interval(nu(j), edf));
  }
  return result;
}

}  // namespace driftlab
