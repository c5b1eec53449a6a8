#pragma once
/// Haar wavelet variances, and the covariance of their estimates, of any process that has a spectrum.
///
/// With S(f) the two-sided density [unit^2] of the samples, f in cycles per sample, and m the half length of a filter,
///   |H_m(f)|^2 = sin^4(pi f m)/(m^2 sin^2(pi f)),   nu_m = int |H_m|^2 S df over |f| <= 1/2,
///   Cov(nu^_i, nu^_j) = 2/max(M_i, M_j) int |H_i|^2 |H_j|^2 S^2 df,   M_i = N - 2 m_i + 1
/// (Percival and Walden 2000, eq. 306d with the cross-scale term; Gaussian noise). Over bins of f inside which S is
/// constant both are linear: nu = A S and Cov = Q (S S). A process then needs no law but its spectrum, and a curve of
/// sixty scales costs one product of a matrix with a vector.
///
/// Bins: 20 to the octave below 0.03 cycles per sample, 256 of equal width above. The density of a bin is taken at the
/// geometric mean of its ends, where a density proportional to f^-2 has its mean. Against the closed forms of the
/// registered processes nu is within 0.3 %; Cov, whose bins are four of these, within 3 % of sqrt(C_ii C_jj) for scales
/// of up to a sixteenth of the record, of quantization noise within 15 %. Beyond, fewer coefficients lie side by side
/// than the formula assumes: 7 % at a quarter of the record, 24 % at half of it.
#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab {

/// Immutable, so that threads may share it. With 60 scales it takes 3 MB and some 30 ms to make.
class SpectralTable {
 public:
  /// `half` holds half lengths in samples, in ascending order; each must satisfy 2 m <= samples.
  SpectralTable(std::span<const std::size_t> half, std::size_t samples);

  /// Where the density of each bin is wanted [cycles per sample], rising.
  [[nodiscard]] const std::vector<double>& frequencies() const { return frequency_; }
  [[nodiscard]] const std::vector<std::size_t>& half() const { return half_; }
  [[nodiscard]] std::size_t samples() const { return samples_; }
  [[nodiscard]] Eigen::Index scales() const { return static_cast<Eigen::Index>(half_.size()); }

  /// nu, one entry per scale [unit^2], of a density given at frequencies() [unit^2].
  [[nodiscard]] Eigen::VectorXd variance(const Eigen::VectorXd& density) const { return filters_ * density; }
  /// The covariance of the estimated variances [unit^4], scales x scales.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::VectorXd& density) const;

 private:
  void tabulate_products(const std::vector<double>& edges);

  std::vector<std::size_t> half_;
  std::size_t samples_;
  std::vector<double> frequency_;
  std::vector<double> width_;
  Eigen::MatrixXd filters_;   ///< scales x bins
  Eigen::MatrixXd products_;  ///< pairs of scales (lower triangle by columns) x coarse bins
};

/// Whole half lengths, `per_octave` to the octave, from 1 to half of the record in scale (2 m <= samples/2).
[[nodiscard]] std::vector<std::size_t> dense_half_lengths(std::size_t samples, int per_octave = 4);

}  // namespace driftlab
