#include "core/variance/total_variance.hpp"

#include "core/variance/prefix_sums.hpp"

#include <memory>

namespace driftlab {

std::vector<double> total_variance(std::span<const double> samples, double pivot, std::span<const std::size_t> m) {
  const std::unique_ptr<double[]> phase = prefix_sums(samples, pivot);
  const std::size_t last = samples.size();
  std::vector<double> variances;
  for (const std::size_t length : m) {
    double sum = 0.0;
    for (std::size_t i = 1; i < last; ++i) {
      const double before = i >= length ? phase[i - length] : 2.0 * phase[0] - phase[length - i];
      const double after = i + length <= last ? phase[i + length] : 2.0 * phase[last] - phase[2 * last - i - length];
      const double difference = before - 2.0 * phase[i] + after;
      sum += difference * difference;
    }
    const auto scale = static_cast<double>(length);
    variances.push_back(sum / (2.0 * scale * scale * static_cast<double>(last - 1)));
  }
  return variances;
}

}  // namespace driftlab
