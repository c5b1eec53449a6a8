#include "core/variance/excess_kurtosis.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {

double difference_excess_kurtosis(std::span<const double> samples) {
  if (samples.size() < 3) {
    return 0.0;
  }
  const auto count = static_cast<double>(samples.size() - 1);
  const double mean = (samples.back() - samples.front()) / count;
  double second = 0.0;
  double fourth = 0.0;
  for (std::size_t t = 1; t < samples.size(); ++t) {
    const double d = samples[t] - samples[t - 1] - mean;
    const double square = d * d;
    second += square;
    fourth += square * square;
  }
  if (!(second > 0.0) || !std::isfinite(fourth)) {
    return 0.0;
  }
  const double excess = fourth * count / (second * second) - 3.0;
  const double error = 2.0 * std::sqrt(24.0 / count);
  return std::fabs(excess) > 2.0 * error ? excess : 0.0;
}

double kurtosis_share(std::size_t half, std::size_t samples) {
  const double filter = 2.0 * static_cast<double>(half);
  const double count = static_cast<double>(samples) - filter + 1.0;
  const double a = std::min(filter, count);
  const double b = std::max(filter, count);
  const double overlap = a * a * (b - a + 1.0) + (a - 1.0) * a * (2.0 * a - 1.0) / 3.0;
  return overlap / (filter * filter * count * count);
}

}  // namespace driftlab
