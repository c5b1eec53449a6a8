#pragma once
/// The Allan variance of a series in windows that move along it.
///
/// Galleani and Tavella (2009), "The dynamic Allan variance", IEEE UFFC 56(3), eq. (10): the overlapping Allan variance
/// (NIST SP 1065, eq. 11) of the samples of one window, for windows that overlap by half. A series that is one noise
/// has rows that differ by scatter alone: at tau = m dt a row of n samples has about n/m degrees of freedom for white
/// noise. A surface over time and tau shows which of the scales change, and when; whether they do is said by a test
/// (core/fit/stationarity.hpp).
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

struct DynamicAllan {
  double window_s = 0.0;
  std::vector<double> start_s;                ///< of each window, after the first sample
  std::vector<double> tau_s;                  ///< octaves up to half a window
  std::vector<std::vector<double>> variance;  ///< [sample unit^2], one row a window, one value a tau
};

inline constexpr std::size_t kFewestWindows = 2;
inline constexpr std::size_t kMostWindows = 512;

/// `windows` (kFewestWindows to kMostWindows) of equal length that overlap by half and cover the series at `dt_s` but
/// for a rest of fewer samples than there are windows. Empty if a window had fewer than 8 samples. O(N) per octave.
[[nodiscard]] DynamicAllan dynamic_allan(std::span<const double> samples, double dt_s, std::size_t windows,
                                         const RunControl& control = {});

}  // namespace driftlab
