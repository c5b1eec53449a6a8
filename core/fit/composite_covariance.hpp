#pragma once
/// A dense curve of wavelet variances, and the covariance S of its estimates under a composite model.
///
/// S is that of the model's spectral density over the table of the basis (core/variance/spectral_table.hpp). It is
/// corrected for three things: scales so long that fewer coefficients lie side by side than the table assumes, where
/// HaarCovariance gives the exact diagonal; missing samples or a robust estimator; and the kurtosis of the noise, given
/// to the rough or the smooth part of the model, whichever the curve names.
///
/// Before any model is known S is that of a mixture: non-negative least squares of everything that the basis scans, in
/// three rounds, with relative weights of the fitted variance and degrees of freedom as if the noise were white.
#include "core/fit/composite_basis.hpp"
#include "core/fit/curve_covariance.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/spectral_lines.hpp"

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace driftlab {

/// The wavelet variances of a curve [unit^2] at the scales of a basis.
struct CompositeCurve {
  Eigen::VectorXd variance;
  /// Lines of the periodogram: where a resonance, or if they are sharp a sinusoid, may be looked for. Asked for once,
  /// where models without them are rejected; empty: there are none.
  std::function<std::vector<SpectralLine>()> lines;
  /// By what missing samples, or a robust estimator, raise the standard deviations; empty: by nothing.
  Eigen::VectorXd raise;
  NoiseShape shape = {};  ///< kurtosis of the noise (core/variance/excess_kurtosis.hpp)
};

/// Not thread safe: of_mixture() keeps what it finds of the long scales for the models after it.
class CompositeCovariance {
 public:
  /// Both must live as long as this.
  CompositeCovariance(const CompositeBasis& basis, const CompositeCurve& curve) : basis_(basis), curve_(curve) {}

  /// To be called first.
  [[nodiscard]] CurveCovariance of_mixture();
  [[nodiscard]] CurveCovariance of_model(const Composite& model) const;

 private:
  /// The covariance that the kurtosis of the noise adds.
  void add_kurtosis(const Composite& model, Eigen::MatrixXd& covariance) const;
  /// Near the end of the record fewer coefficients than the table assumes lie side by side.
  void correct_long_scales(const Composite& mixture);

  const CompositeBasis& basis_;
  const CompositeCurve& curve_;
  Eigen::VectorXd raise_;  ///< of the standard deviations
};

}  // namespace driftlab
