#pragma once
/// Progress and cancellation as arguments, so that core/ neither prints nor reads a clock.
#include <functional>
#include <stop_token>
#include <string_view>

namespace driftlab {

/// Called with a stage name ("variance", "fit WN+GM", ...) and the fraction of the whole call done, 0 to 1, never
/// falling. Called from the calling thread only.
using ProgressFunction = std::function<void(std::string_view stage, double fraction)>;

/// What a long computation is given beside its input. Both members may be empty.
/// A computation polls `stop` at least every 100 ms of work and then returns ErrorCode::Cancelled.
struct RunControl {
  std::stop_token stop;
  ProgressFunction progress;

  void report(std::string_view stage, double fraction) const {
    if (progress) {
      progress(stage, fraction);
    }
  }
};

}  // namespace driftlab
