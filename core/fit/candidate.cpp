#include "core/fit/candidate.hpp"

#include "core/process/dense.hpp"

#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr int kCovarianceRounds = 2;

std::size_t count_parameters(const Model& active) {
  std::size_t count = 0;
  for (const Process& process : active) {
    count += process.parameters.size();
  }
  return count;
}

double log_det(const Eigen::MatrixXd& covariance, const MomentWeights& weights) {
  // The whitening is a triangle times a diagonal: its determinant is the product of its diagonal.
  (void)covariance;
  return -2.0 * weights.whitening.diagonal().array().abs().log().sum();
}

}  // namespace

double Candidate::criterion(double samples) const {
  return log_fit->minimum() + static_cast<double>(structure.parameter_count()) * std::log(samples);
}

Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure, const Eigen::VectorXd& sd,
                        HaarCovariance& plan) {
  return fit_candidate(moments, structure, sd, [&](const Model& model) { return plan.matrix(model); });
}

Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure, const Eigen::VectorXd& sd,
                        const CovarianceLaw& covariance_of) {
  Candidate candidate;
  candidate.structure = structure;
  candidate.diagonal = fit_gmwm(moments, structure, MomentWeights::from_sd(sd));
  candidate.fit = candidate.diagonal;
  Model active = candidate.fit.active();
  if (active.empty()) {
    candidate.quasi_likelihood = std::numeric_limits<double>::infinity();
    return candidate;
  }
  candidate.covariance = covariance_of(active);
  for (int round = 0; round < kCovarianceRounds; ++round) {
    GmwmSolution next = fit_gmwm(moments, structure, MomentWeights::from_covariance(candidate.covariance));
    if (next.active().empty()) {
      break;
    }
    candidate.fit = std::move(next);
    active = candidate.fit.active();
    candidate.covariance = covariance_of(active);
  }
  const MomentWeights own = MomentWeights::from_covariance(candidate.covariance);
  const Eigen::VectorXd error = moments.nu - modelled_variance(moments, active);
  candidate.quasi_likelihood = (own.whitening * error).squaredNorm() + log_det(candidate.covariance, own);
  candidate.parameters = count_parameters(active);
  candidate.log_fit = std::make_unique<LogFit>(moments, active, candidate.covariance);
  return candidate;
}

Equation8 equation_8(const WaveletMoments& moments, const GmwmSolution& solution, const Eigen::VectorXd& sd,
                     const Eigen::MatrixXd& covariance) {
  const Model active = solution.active();
  const Eigen::VectorXd weight = sd.cwiseInverse();
  const Eigen::VectorXd error = weight.cwiseProduct(moments.nu - modelled_variance(moments, active));
  Eigen::MatrixXd derivative(moments.nu.size(), static_cast<Eigen::Index>(count_parameters(active)));
  std::array<double, kMostParameters> gradient{};
  for (Eigen::Index j = 0; j < derivative.rows(); ++j) {
    Eigen::Index column = 0;
    for (const Process& process : active) {
      const auto row = static_cast<std::size_t>(j);
      process.haar_gradient(moments.half[row], moments.dt_at(row), gradient);
      for (std::size_t k = 0; k < process.parameters.size(); ++k) {
        derivative(j, column++) = gradient[k] * weight(j);
      }
    }
  }
  for (Eigen::Index k = 0; k < derivative.cols(); ++k) {
    const double length = derivative.col(k).norm();
    derivative.col(k) /= length > 0.0 ? length : 1.0;
  }
  // tr(W C W D (D'WD)^-1 D') = tr(H S): H the projector on the weighted derivatives, S the weighted covariance.
  const Eigen::MatrixXd scaled = weight.asDiagonal() * covariance * weight.asDiagonal();
  const Eigen::MatrixXd projected = derivative * least_squares(derivative, scaled);
  return {error.squaredNorm(), 2.0 * std::max(0.0, projected.trace())};
}

}  // namespace driftlab
