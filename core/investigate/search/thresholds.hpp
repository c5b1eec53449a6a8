#pragma once
/// The thresholds at which a cause is reported and called identified.
///
/// A cause is reported if its score exceeds kThreshold. Each score includes a penalty for the choice among scopes,
/// shapes and times, so one threshold serves all causes. It was set so that at most 5 % of simulated studies without
/// any effect have a finding (tests/hidden/RESULTS.md). The cause is `identified` if no declared rival comes within
/// kMargin of its score, and `ambiguous` otherwise.

namespace driftlab::investigate {

inline constexpr double kThreshold = 10.0;
inline constexpr double kMargin = 6.0;

}  // namespace driftlab::investigate
