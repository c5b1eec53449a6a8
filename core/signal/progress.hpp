#pragma once
/// Progress, cancellation and threads as arguments, so that core/ neither prints, reads a clock nor starts threads.
#include "core/signal/executor.hpp"

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>
#include <utility>

namespace driftlab {

/// Whether a loop over many cheap turns ends at turn `i`: looks at the token every 16,384th.
[[nodiscard]] inline bool polled(const std::stop_token& stop, std::size_t i) {
  return i % 16384 == 0 && stop.stop_requested();
}

/// Called with a stage name ("variance", "fit WN+GM", ...) and the fraction of the whole call done, 0 to 1, never
/// falling. Called from the calling thread only.
using ProgressFunction = std::function<void(std::string_view stage, double fraction)>;

/// What a long computation is given beside its input. Every member may be empty.
/// A computation polls `stop` at least every 100 ms of work and then returns ErrorCode::Cancelled. Its result is the
/// same to the bit whatever `threads` it may use.
struct RunControl {
  std::stop_token stop;
  ProgressFunction progress;
  ThreadShare threads = {};

  void report(std::string_view stage, double fraction) const {
    if (progress) {
      progress(stage, fraction);
    }
  }

  /// The same stop token and threads with another progress function: for a part of a computation.
  [[nodiscard]] RunControl reporting(ProgressFunction other) const { return {stop, std::move(other), threads}; }
};

}  // namespace driftlab
