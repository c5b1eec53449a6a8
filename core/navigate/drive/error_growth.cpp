#include "core/navigate/drive/error_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::drive {
double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double value_at_share(std::span<const double> sorted, double share) {
  return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

double middle_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

ErrorGrowth growth_of(const std::vector<DriveOutage>& outages, double duration_s) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ErrorGrowth growth;
  for (std::size_t k = 0; k < kGrowthPoints; ++k) {
    std::vector<double> errors;
    for (const DriveOutage& scored : outages) {
      if (k < scored.growth_m.size() && std::isfinite(scored.growth_m[k])) {
        errors.push_back(scored.growth_m[k]);
      }
    }
    std::sort(errors.begin(), errors.end());
    const bool any = !errors.empty();
    growth.time_s.push_back(duration_s * static_cast<double>(k + 1) / static_cast<double>(kGrowthPoints));
    growth.count.push_back(errors.size());
    growth.rms_m.push_back(any ? root_mean_square(errors) : kNone);
    growth.p05_m.push_back(any ? value_at_share(errors, 0.05) : kNone);
    growth.median_m.push_back(any ? middle_of(errors) : kNone);
    growth.p95_m.push_back(any ? value_at_share(errors, 0.95) : kNone);
  }
  return growth;
}

}  // namespace driftlab::drive
