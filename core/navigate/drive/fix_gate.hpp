#pragma once
/// Acceptance of a receiver's fixes: a gate on the normalised innovation, with a memory.
///
/// A fix is rejected where the largest normalised square of its innovations is above the gate. A filter that has gone
/// astray rejects every fix, so that after five in a row the receiver is right and the filter is not: fixes are
/// believed again, however far off, until about as many have agreed by themselves as had disagreed. The memory caps
/// that count: after a long disagreement belief would otherwise last as long as the disagreement did.
///
/// The filter's options remember 60 fixes: a minute of a receiver at 1 Hz, which is long against the few fixes in which
/// a filter comes back to its receiver and short against a drive. accuracy_recorded_drives ('*GatesMemory*') measures
/// errors and rejected fixes of a recorded drive for memories from 5 to 1000.
#include <algorithm>

namespace driftlab::drive {

class FixGate {
 public:
  static constexpr int kRejectedInARow = 5;

  /// `gate` above 0.
  FixGate(double gate, int memory) : gate_(gate), memory_(memory) {}

  /// Whether the fix whose largest normalised squared innovation is `worst` counts.
  [[nodiscard]] bool accepts(double worst) {
    const bool believed = in_a_row_ >= kRejectedInARow;
    const bool agrees = worst <= gate_;
    in_a_row_ = agrees ? (believed ? in_a_row_ - 1 : 0) : std::min(in_a_row_ + 1, memory_);
    return agrees || believed;
  }

 private:
  double gate_;
  int memory_;
  int in_a_row_ = 0;
};

}  // namespace driftlab::drive
