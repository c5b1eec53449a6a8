#include "core/variance/dynamic_allan.hpp"

#include "core/variance/haar_variance.hpp"

namespace driftlab {

DynamicAllan dynamic_allan(std::span<const double> samples, double dt_s, std::size_t windows,
                           const RunControl& control) {
  constexpr std::size_t kFewestSamples = 8;
  DynamicAllan result;
  const std::size_t half = samples.size() / (windows + 1);
  if (2 * half < kFewestSamples) {
    return result;
  }
  result.window_s = static_cast<double>(2 * half) * dt_s;
  for (std::size_t w = 0; w < windows && !control.stop.stop_requested(); ++w) {
    const std::span<const double> part = samples.subspan(w * half, 2 * half);
    double mean = 0.0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      mean += (part[i] - mean) / static_cast<double>(i + 1);
    }
    const HaarVariance curve = haar_variance(part, mean, control);
    std::vector<double> row;
    for (std::size_t j = 0; j < curve.scales(); ++j) {
      row.push_back(2.0 * curve.variance[j]);  // AV = 2 WV
      if (w == 0) {
        result.tau_s.push_back(static_cast<double>(curve.half[j]) * dt_s);
      }
    }
    result.start_s.push_back(static_cast<double>(w * half) * dt_s);
    result.variance.push_back(std::move(row));
  }
  return result;
}

}  // namespace driftlab
