#pragma once
/// A recording while it grows: what a person who waits beside the sensor wants to know.
///
/// The Allan deviation so far at octaves of tau, with the intervals that a finished recording gets
/// (core/variance/variance_intervals.hpp); white noise as IEEE Std 952 reads it off, N = sigma(tau) sqrt(tau), at the
/// longest tau of at most 1 s around which the slope is -1/2; and whether the sensor lies still. A step of the time
/// stamps longer than 1.5 times the median step is a gap, and the deviation is computed on the longest run without a
/// gap. All figures are provisional: the characterisation of the finished recording replaces them.
#include "core/signal/estimate.hpp"
#include "core/signal/unit.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

struct GrowingRecording {
  std::size_t samples = 0;
  std::size_t gaps = 0;
  double seconds = 0.0;           ///< from the first to the last stamp
  std::optional<double> rate_hz;  ///< one over the median step; nothing before the third sample
  std::vector<double> tau_s;      ///< empty below 16 samples in a run
  std::vector<double> deviation;  ///< Allan deviation [unit]
  std::vector<Interval> ci95;
  std::optional<Estimate> n;  ///< [unit s^(1/2)]
  std::string n_reason;       ///< why there is none
  double next_tau_s = 0.0;    ///< the averaging time that is to come
  double next_in_s = 0.0;     ///< how long it takes to get there
};

/// `time_s` and `values` of one channel, equally long; NaN is taken for missing. O(N log N).
[[nodiscard]] GrowingRecording look_at_growth(std::span<const double> time_s, std::span<const double> values);

/// The standard deviation over three seconds below which a sensor lies still: 0.02 rad/s of an angular rate, 0.3 m/s^2
/// of a specific force; 0 for another dimension. Chosen, not measured, to lie above the noise
/// of a sensor that lies still and below what a hand does.
[[nodiscard]] double still_deviation(Dimension dimension);

/// Whether the sensor lay still in the last three seconds, by its standard deviation. Nothing for other units and for
/// fewer than ten samples.
[[nodiscard]] std::optional<bool> lies_still(std::span<const double> time_s, std::span<const double> values,
                                             const Unit& unit);

}  // namespace driftlab
