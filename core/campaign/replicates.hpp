#pragma once
/// Several recordings of one condition as one fit, and whether they agree.
///
/// Multi-signal GMWM: one parameter vector for all recordings, the sum of their weighted distances, each recording with
/// its own length, sample interval and covariance (Radi, Bakalli, Guerrier, El-Sheimy, Sesia and Molinari 2019, "A
/// multisignal wavelet variance-based framework for inertial sensor stochastic error modeling"). The recordings are
/// independent, so the covariance of the stacked wavelet variances is block diagonal, and the joint fit is that of one
/// longer signal (core/fit/candidate.hpp). Each recording keeps the covariance and the discrepancy of its own curve.
/// One recording is the case R = 1 and gives what characterise_channel gives.
///
/// Nothing but the wavelet variances, sample count and interval of each recording is needed: a stored result can be
/// pooled without its samples.
///
/// Agreement. The recordings are compared by the ratio of two likelihoods: one parameter vector for all, or one for
/// each. The least L of the stack exceeds the sum of the least L of the single recordings; both are taken under the
/// covariances of the stack. If the recordings share their parameters, the excess is chi-square with (R - 1) p degrees
/// of freedom, where p counts the parameters of the components that the joint fit has. (L is a quasi-likelihood with
/// the right covariance, and the models are nested.) Measured size and power: tests/ACCURACY.md.
#include "core/campaign/reported_channel.hpp"
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"
#include "core/fit/fit_report.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab {

/// The wavelet-variance curve of a recording's channel. All records of one stack are in one unit.
struct WaveletRecord {
  std::vector<std::size_t> half;  ///< half lengths m, rising, in samples
  std::vector<double> variance;   ///< [unit^2]; entries that are not positive are left out
  /// Variance of each entry relative to the classical estimate's of a whole record: 1 over the efficiency of a robust
  /// estimate or of one with gaps. Empty: 1.
  std::vector<double> inflation = {};
  std::size_t samples = 0;  ///< of the grid: those that are missing count
  double dt_s = 0.0;
  double from_tau_s = 0.0;   ///< scales of smaller tau describe the noise, but no model is fitted to them
  double discrepancy = 0.0;  ///< by how much the curve may differ from every model (core/fit/discrepancy.hpp)
};

/// The input of a joint fit from one channel [SI]: its wavelet variances, or the robust ones if gross errors move the
/// classical ones (verdict `contaminated`).
[[nodiscard]] WaveletRecord record_of(const ReportedChannel& channel);

/// The same with the estimator that the caller wants, for curves that are compared with each other. A channel without
/// robust variances gives its classical ones; so does a scale at which the robust estimator of a channel without gross
/// errors has no root.
[[nodiscard]] WaveletRecord record_of(const ReportedChannel& channel, bool robust);

/// Do the recordings share their parameters?
struct Agreement {
  double statistic = 0.0;
  double dof = 0.0;
  double p = 1.0;
};

/// The stack of the recordings of one condition. Keeps the lag sums of its covariances, which recordings of equal
/// length share; not thread safe.
class Replicates {
 public:
  /// Errors: InvalidArgument (no record; records of different shape than they say), TooFewSamples (fewer than two
  /// positive variances in a record).
  [[nodiscard]] static Result<Replicates> stack(const std::vector<WaveletRecord>& records);

  Replicates(Replicates&&) noexcept;
  Replicates& operator=(Replicates&&) noexcept;
  Replicates(const Replicates&) = delete;
  Replicates& operator=(const Replicates&) = delete;
  ~Replicates();

  [[nodiscard]] std::size_t count() const;
  /// Rows of the stack: the most parameters that a model may have.
  [[nodiscard]] std::size_t rows() const;
  /// N of the criterion: samples of all recordings together.
  [[nodiscard]] double samples() const;
  /// SI units in one unit of the moments, which are scaled to a largest variance of 1.
  [[nodiscard]] double unit() const;

  /// The joint fit. It refers to this stack, which must outlive it. log_fit is null where no component is positive.
  /// Cost at 2 x 16 scales: about that of one recording.
  [[nodiscard]] Candidate fit(const ModelStructure& structure);

  /// Empty for one recording and for a fit without a positive component.
  [[nodiscard]] std::optional<Agreement> agreement(const Candidate& joint) const;

  /// The joint fit as it is told to people: parameters in SI. Profile intervals cost some 20 minimisations each. Where
  /// one of several Gauss-Markov processes vanished, or has a correlation time below one sample, none of them is given:
  /// the intervals would be those of the smaller model, and the name of the remaining process a guess.
  [[nodiscard]] ModelFit report(Candidate& joint, IntervalMethod method) const;

 private:
  struct Blocks;
  explicit Replicates(std::unique_ptr<Blocks> blocks);
  std::unique_ptr<Blocks> blocks_;
};

}  // namespace driftlab
