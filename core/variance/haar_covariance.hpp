#pragma once
/// Covariance of the estimated Haar wavelet variances across scales, under a Gaussian model, at finite N.
///
/// For filters of half lengths mi <= mj, let gamma_ij(h) be the covariance of their coefficients h samples apart and
/// n_ij(h) the number of pairs that far apart. Then
///   Cov(nu_i, nu_j) = 2/(Mi Mj) sum_h n_ij(h) gamma_ij(h)^2 + 4 mu_i mu_j/(Mi Mj) sum_h n_ij(h) gamma_ij(h),
/// where mu is the mean of the coefficients under a trend. This is exact for Gaussian data (Percival 1995, Greenhall
/// and Riley 2003).
///
/// gamma^2 n is smooth between the lags 0, m_i, m_j - m_i, m_j and m_i + m_j, so the sum is evaluated by quadrature on
/// stretches between these lags. The stretches are m_i/2 long near these lags and grow fourfold with distance; each
/// uses six lags (the Gauss-Legendre nodes rounded to whole lags, with weights that are exact for polynomials over
/// whole lags). This takes some 100 lags for a pair of scales, and the error is below 0.1 % of sqrt(C_ii C_jj) for
/// every process (0.3 % for flicker noise). Where a process rings (core/process/ringing.hpp) gamma oscillates around
/// the kinks, and the stretches there are made short enough to follow it, at most 256 of them; beyond these, which the
/// ringing of a resonance outlasts if its quality is above 80, it is only sampled.
#include "core/process/model.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace driftlab {

/// The quadrature lags, and everything about them that does not depend on a model's parameters, kept for repeated use.
/// Not thread safe, because it caches the kinds of processes it has met: use one object per call.
class HaarCovariance {
 public:
  /// `half` holds the half lengths in samples, in ascending order; each must satisfy 2 m <= samples.
  HaarCovariance(std::span<const std::size_t> half, std::size_t samples, double dt_s);
  ~HaarCovariance();
  HaarCovariance(HaarCovariance&& other) noexcept;
  HaarCovariance& operator=(HaarCovariance&& other) noexcept;
  HaarCovariance(const HaarCovariance&) = delete;
  HaarCovariance& operator=(const HaarCovariance&) = delete;

  /// Covariance matrix of the estimated variances [unit^4], scales x scales. It is positive definite even for a
  /// deterministic model: 10^-16 of the squared variance is added for rounding.
  [[nodiscard]] Eigen::MatrixXd matrix(const Model& model);

  /// The diagonal of matrix() alone, in O(scales) instead of O(scales^2). It caches every shape parameter it is given,
  /// and is meant for models made of a fixed set of processes.
  [[nodiscard]] Eigen::VectorXd diagonal(const Model& model);

  /// S_k = 1/(Mi Mj) sum_h n_ij(h) rho_ij(h)^k for k = 2, 4, ..., 2 * kEvenPowers, where rho is the correlation of the
  /// coefficients under the model. The variance of the mean of any even function of the coefficients is a combination
  /// of these sums.
  static constexpr std::size_t kEvenPowers = 8;
  [[nodiscard]] std::array<double, kEvenPowers> correlation_sums(std::size_t i, std::size_t j, const Model& model);
  /// S_k of scale j if only every `stride`-th coefficient is used. rho^k is then summed at those lags alone, up to 4 m.
  /// The peak of rho^k at lag 0 is resolved more coarsely the higher k is.
  [[nodiscard]] std::array<double, kEvenPowers> thinned_sums(std::size_t j, std::size_t stride, const Model& model);

  [[nodiscard]] double dt_s() const { return dt_s_; }
  [[nodiscard]] std::span<const double> half() const { return half_; }
  [[nodiscard]] std::size_t samples() const { return static_cast<std::size_t>(samples_); }

 private:
  struct Rules;
  struct Pair {
    std::vector<double> lag;
    std::vector<double> weight;  ///< quadrature weight times n_ij, both signs of the lag together, over Mi Mj
    /// gamma at level 1 by kind and shapes: for kinds without shape, and for the shapes given to diagonal().
    std::map<std::pair<const ProcessKind*, std::array<double, kMostShapes>>, std::vector<double>> unit;
  };
  [[nodiscard]] std::optional<Ringing> ringing_of(const Model& model) const;
  Pair& pair(std::size_t i, std::size_t j, const Model& model);
  /// Computes gamma_ij at the lags of `plan` into scratch_.
  void fill(Pair& plan, std::size_t i, std::size_t j, const Model& model, bool remember_shapes);
  /// The sums S_k of the correlations that are in scratch_.
  [[nodiscard]] std::array<double, kEvenPowers> sums_of(const Pair& plan, std::size_t i, std::size_t j,
                                                        const Model& model) const;
  double entry(std::size_t i, std::size_t j, const Model& model, bool remember_shapes);

  std::vector<double> half_;
  double samples_;
  double dt_s_;
  std::unique_ptr<Rules> rules_;
  std::vector<Pair> pairs_;
  Pair ringing_pair_;          ///< the lags of the latest pair of scales under a model that rings
  std::vector<Pair> thinned_;  ///< the lags of each scale for the latest stride
  std::vector<std::size_t> stride_;
  std::vector<double> scratch_;
};

}  // namespace driftlab
