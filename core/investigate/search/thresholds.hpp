#pragma once
/// When a cause is reported, and how surely.
///
/// A cause is reported where its score exceeds kThreshold. The choice among scopes, shapes and times is paid for in
/// each score, so that one threshold stands for all: it was set so that at most 5 % of simulated studies without any
/// effect have a finding (tests/hidden/RESULTS.md). It is `identified` where no declared rival comes within kMargin of
/// its score, else `ambiguous`.

namespace driftlab::investigate {

inline constexpr double kThreshold = 10.0;
inline constexpr double kMargin = 6.0;

}  // namespace driftlab::investigate
