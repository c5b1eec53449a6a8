#include "core/signal/decimated_trace.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {

std::vector<TraceBucket> decimated_trace(std::span<const double> samples, std::size_t most) {
  std::vector<TraceBucket> buckets;
  const std::size_t length = std::max<std::size_t>(1, (samples.size() + most - 1) / most);
  for (std::size_t first = 0; first < samples.size(); first += length) {
    TraceBucket bucket{first, 0, 0.0, 0.0, 0.0};
    double sum = 0.0;
    for (const double x : samples.subspan(first, std::min(length, samples.size() - first))) {
      if (!std::isfinite(x)) {
        continue;
      }
      bucket.low = bucket.present == 0 ? x : std::min(bucket.low, x);
      bucket.high = bucket.present == 0 ? x : std::max(bucket.high, x);
      sum += x;
      ++bucket.present;
    }
    bucket.mean = bucket.present > 0 ? sum / static_cast<double>(bucket.present) : 0.0;
    buckets.push_back(bucket);
  }
  return buckets;
}

}  // namespace driftlab
