#pragma once
/// The characterisation of one channel: everything driftlab says about the stochastic errors of one sensor axis in one
/// recording. Values only; `characterise_channel` (core/fit/characterise.hpp) makes it, schema/json writes it down
/// (spec/results.md), the parameter table reads it. All numbers are SI: a channel of angular rate is in rad/s.
#include "core/fit/further_curves.hpp"
#include "core/fit/stationarity.hpp"
#include "core/process/process.hpp"
#include "core/signal/estimate.hpp"
#include "core/variance/dynamic_allan.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// Overlapping Allan variance at tau = m dt [channel unit^2], NIST SP 1065 eq. (11); one entry per m.
struct AllanCurve {
  std::vector<double> tau_s;
  std::vector<double> variance;
  std::vector<Interval> ci95;  ///< of the variance
  std::vector<double> edf;     ///< equivalent degrees of freedom of each variance
};

/// Haar MODWT wavelet variance at scales of n = 2^j samples (filter length) [channel unit^2]; AV(2^(j-1) dt) = 2 WV_j.
struct HaarCurve {
  std::vector<std::size_t> scale;
  std::vector<double> variance;
  std::vector<Interval> ci95;
  std::vector<double> edf;
  /// Variance of the estimate without gaps over that of this one, per scale; empty where nothing is missing.
  std::vector<double> efficiency;
  /// Robust estimate per scale. While no sample is flagged that of the Tukey biweight, tuned to an efficiency of 0.6
  /// and empty where undefined, its interval {0, 0} there (core/variance/robust_variance.hpp); else the sample-wise one
  /// (core/fit/sample_wise_variance.hpp).
  std::vector<std::optional<double>> robust_variance;
  std::vector<Interval> robust_ci95;
  std::vector<double> robust_efficiency;
  bool robust_sample_wise = false;
};

/// Whether gross errors move the variances (core/variance/contamination.hpp).
struct Contamination {
  std::string verdict = "undecided";         ///< clean, contaminated, undecided
  double p = 1.0;                            ///< of the test that robust and classical variance estimate the same
  std::vector<std::size_t> disjoint_scales;  ///< scales n at which the two 95 % intervals do not meet
  /// Samples with an error that passes a false-discovery rate of 1 %; where the sample-wise estimate was not asked for
  /// or found nothing, first differences beyond 4.5 robust standard deviations.
  std::size_t flagged_samples = 0;
  /// Events of gross errors: flagged samples within 1 s of one another are one. Empty where samples were not flagged
  /// one by one.
  std::optional<std::size_t> bursts;
  bool not_gaussian = false;  ///< they differ by the shape of the noise, not by a few samples
};

/// The limit of a level that the data do not bound: infinity.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// One parameter of a process in a fit. `estimate` is empty where the data do not identify it; `reason` then says why
/// in a sentence.
struct FittedParameter {
  const ParameterSpec* declared = nullptr;  ///< one of the process' kind->parameters: name and unit
  std::optional<Estimate> estimate;
  std::string reason;
  /// Where there is no estimate: the level is below this with 95 % confidence (infinite: nothing bounds it).
  double upper_limit = kUnbounded;
};

/// A process with estimates in the place of values (core/process/process.hpp).
struct FittedProcess {
  const ProcessKind* kind = nullptr;
  std::vector<FittedParameter> parameters;  ///< as declared by kind->parameters
};

/// A model is rejected where its J test has a p below this.
inline constexpr double kRejected = 0.01;

/// Whether a model stands whose J test has this p: at kRejected it does, where p is not a number it does not.
[[nodiscard]] constexpr bool stands_at(double p) { return p >= kRejected; }

/// Over-identification test of a fit: statistic ~ chi-square(dof) where the model is right (Hansen 1982); dof is the
/// number of scales less that of parameters, less up to 1.15 for what the longest scales scatter too little.
struct JTest {
  double statistic = 0.0;
  double dof = 0.0;
  double p = 1.0;
};

/// One candidate model fitted by GMWM (Guerrier et al. 2013), whatever its outcome.
struct ModelFit {
  std::string model;    ///< `WN`, `WN+GM`, `WN+2GM+RW`, ...
  bool robust = false;  ///< fitted to the robust wavelet variances
  std::vector<FittedProcess>
      processes;               ///< canonical order: kinds as registered, Gauss-Markov fastest (largest beta) first
  double objective = 0.0;      ///< squared distance L on the logarithms at the optimum, which ranks
  double wic = 0.0;            ///< criterion that ranks (smaller is better)
  double eq8 = 0.0;            ///< seed paper's eq. 8 with optimism 2 tr(W C W D (D'WD)^-1 D'), diagonal W
  double optimism = 0.0;       ///< its second term, never negative
  std::size_t parameters = 0;  ///< free parameters of the fit (those of vanished components do not count)
  bool plausible = false;      ///< in the set of models that the data cannot tell apart (holds the truth in 85-98 %)
  /// L + 2p above the least of all fits of the channel (core/fit/closeness.hpp): 0 is the closest to the data. Empty
  /// for a fit without a finite criterion.
  std::optional<double> distance_2p;
  std::optional<JTest> j_test;  ///< at discrepancy 0; empty where no degree of freedom is left
  /// `accepted`: the J test does not reject at 0.01. `described`: it does, but the variances are within 2 % of the
  /// model's but for their scatter. `not_described`: they are not. `untested`: there is no J test.
  std::string verdict = "untested";
  /// The relative error of the variances that the model leaves (core/fit/discrepancy.hpp): 0 where it is accepted. The
  /// intervals allow for it.
  double described_within = 0.0;
  /// Ratio of the best to the worst known combination of the logarithms of the parameters (1: all equally well).
  double condition_number = 1.0;
  /// Parameters at an end of their range: `random_walk.K` where the component vanished, `gauss_markov.beta` where the
  /// record cannot tell the process from white noise or from a random walk.
  std::vector<std::string> bounds_active;
  std::string intervals = "profile";  ///< how the parameters' intervals were made: `profile`, `sandwich`, `bootstrap`
  std::string status;  ///< `converged`, `not_converged`, `collapsed` (a component vanished), `unidentifiable`
  std::vector<std::string> warnings;

  /// Whether no fit of the channel is closer to the data.
  [[nodiscard]] bool closest() const { return distance_2p == 0.0; }
};

/// Coefficients of IEEE Std 952, those of the composite models that describe the curve
/// (core/fit/ieee952_coefficients.hpp). Empty: not there or not to be told, and its reason says why; its limit is what
/// it is below with 95 % confidence where a model describes the curve without it (infinite: nothing bounds it).
struct AllanParameters {
  std::optional<Estimate> q;  ///< quantization noise [channel unit * s]
  std::optional<Estimate> n;  ///< angle (velocity) random walk [channel unit * sqrt(s)]
  std::optional<Estimate> b;  ///< bias instability [channel unit]; Allan deviation floor 0.664 B
  std::optional<Estimate> k;  ///< rate random walk [channel unit / sqrt(s)]
  std::optional<Estimate> r;  ///< rate ramp [channel unit / s]
  std::string q_reason, n_reason, b_reason, k_reason, r_reason;
  double q_limit = kUnbounded;
  double n_limit = kUnbounded;
  double b_limit = kUnbounded;
  double k_limit = kUnbounded;
  double r_limit = kUnbounded;
  double b_tau_s = 0.0;  ///< averaging time at which B takes the largest share of the Allan variance; 0 without B
};

/// The composite model that describes the curve (core/fit/curve_description.hpp).
struct CurveDescription {
  std::string model;  ///< `MA+PL`, ...
  /// `accepted`: not rejected at 1 % with no discrepancy; `described`: within `discrepancy`; `not_described`: by
  /// nothing within 10 %.
  std::string verdict;
  double discrepancy = 0.0;  ///< of the variances that is left to the model, relative
  double p = 0.0;            ///< of the squared distance; with a discrepancy a measure, no test
  std::size_t parameters = 0;
  std::size_t scales = 0;
  std::vector<FittedProcess> processes;   ///< intervals from the curvature
  std::vector<std::string> alternatives;  ///< models that describe the curve as well
  /// What a reader must know: that nothing describes the curve, or what of the model none of the nine candidates of
  /// Table 3 of the seed paper has (a resonance at 20 Hz). Empty where there is nothing to say.
  std::string sentence;
};

struct ChannelCharacterisation {
  std::size_t samples = 0;
  std::size_t missing = 0;  ///< grid points between them without a sample
  double dt_s = 0.0;
  double mean = 0.0;  ///< of the analysed samples
  AllanCurve allan;
  HaarCurve haar;
  FurtherCurves further;  ///< on request
  Contamination contamination;
  AllanParameters allan_parameters;
  /// By how much, relative to its variances, the curve may differ from every candidate (core/fit/discrepancy.hpp): 0
  /// where a candidate is accepted. It is in the weights of all fits.
  double discrepancy = 0.0;
  double from_tau_s = 0.0;                      ///< models were fitted to the scales of tau from here on
  std::optional<CurveDescription> description;  ///< empty where the record is too short or constant
  std::vector<ModelFit> fits;                   ///< best first
  std::size_t best = 0;                         ///< index into fits
  Stationarity stationarity;                    ///< whether it is one noise; sizes of jumps in the channel unit
  std::optional<DynamicAllan> dynamic_allan;    ///< where it was asked for
  std::vector<std::string> warnings;
};

}  // namespace driftlab
