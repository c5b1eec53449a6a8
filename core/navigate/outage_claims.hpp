#pragma once
/// What a comparison of filters says about the claims of the seed paper, in words.
///
/// The attribution goes from M_stat(AV) to M_dyn(GMWM) through the control filters, one change at a time, and the parts
/// add up to the whole:
///   low-frequency process noise: M_stat(Neq)+RW against M_stat(AV); low-frequency noise is modelled, no new states;
///   Gauss-Markov states: M_stat(GMWM) against M_stat(Neq)+RW; the same noise is now estimated;
///   switching: M_dyn(GMWM) against M_stat(GMWM); the parameters follow the rate.
/// For the Allan variance alone, switching is M_dyn(AV) against M_stat(AV). Negative differences are gains.
///
/// The claim that one filter is better is supported if the whole 95 % interval of the paired difference is below 0 and
/// the gain is at least kPracticalSize. Common random numbers make differences statistically significant that are too
/// small to matter; such differences are reported as being of no practical size. A claim of a size is supported if the
/// interval of the relative difference contains it. The gain is attributed to the switching if there is a gain, the
/// interval of the switching's part is below 0, and that part is more than half of the whole.
#include "core/navigate/outage_evaluation.hpp"

namespace driftlab {

/// Relative difference of two mean errors below which a difference is of no practical size.
inline constexpr double kPracticalSize = 0.01;

struct Attribution {
  PairedDifference total;
  PairedDifference low_frequency_noise;
  PairedDifference gauss_markov_states;
  PairedDifference switching;
  PairedDifference switching_av;
};

struct Claim {
  std::string claim;
  bool supported = false;
  std::string because;
};

/// Nothing where the six filters of the paper's comparison are not all there.
[[nodiscard]] std::optional<Attribution> attribute(const OutageEvaluation& evaluation);

/// Claims of the paper that the evaluation can judge; empty where `attribute` gives nothing.
[[nodiscard]] std::vector<Claim> judge_claims(const OutageEvaluation& evaluation);

}  // namespace driftlab
