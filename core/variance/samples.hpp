#pragma once
/// Conditions that a series must meet before any variance is formed, and its mean without loss of digits.
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <span>

namespace driftlab {

struct SampleSummary {
  double mean = 0.0;
  double minimum = 0.0;
  double maximum = 0.0;
  [[nodiscard]] bool constant() const { return minimum == maximum; }
};

/// Largest magnitude accepted: the square of a sum over 10^12 such samples is still a double.
inline constexpr double kLargestSample = 1e140;

/// The array is read once. The mean is summed block by block relative to the first sample, so that a bias costs no
/// digits. Errors: NonFinite and OutOfRange, naming the row (field `row`, counted from 1); Cancelled, since the token
/// is polled every million samples.
[[nodiscard]] Result<SampleSummary> summarise(std::span<const double> samples, const RunControl& control = {});

}  // namespace driftlab
