#include "core/navigate/drive/rest_correlation.hpp"

#include "core/navigate/drive/start.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab::drive {
namespace {

constexpr double kLongRest = 20.0;        ///< [s]
constexpr double kEdge = 1.0;             ///< [s] at either end of a rest
constexpr double kSparsestFixes = 1.25;   ///< [s] between two fixes, of which one is to be a second later
constexpr std::size_t kFewestFixes = 10;  ///< of a rest

struct StillFix {
  double time_s = 0.0;
  Vector3 error_m = Vector3::Zero();  ///< from the rest's mean
};

using StillFixes = std::vector<StillFix>;

/// The fixes of a rest; too few are none.
StillFixes fixes_in(const Drive& drive, const Rest& rest) {
  StillFixes still;
  Vector3 mean = Vector3::Zero();
  for (const Fix& fix : drive.fixes) {
    if (fix.time_s > rest.from_s + kEdge && fix.time_s < rest.to_s - kEdge) {
      still.push_back({fix.time_s, fix.position_ecef_m - drive.fixes.front().position_ecef_m});
      mean += still.back().error_m;
    }
  }
  if (still.size() < kFewestFixes) {
    return {};
  }
  mean /= static_cast<double>(still.size());
  for (StillFix& fix : still) {
    fix.error_m -= mean;
  }
  return still;
}

double median_step(const std::vector<StillFixes>& rests) {
  std::vector<double> steps;
  for (const StillFixes& rest : rests) {
    for (std::size_t i = 1; i < rest.size(); ++i) {
      steps.push_back(rest[i].time_s - rest[i - 1].time_s);
    }
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Mean products of pairs that are 0, 1, 2, ... steps apart, as far as `lags`; 0 for a lag without pairs.
std::vector<double> mean_products(const std::vector<StillFixes>& rests, double step_s, std::size_t lags) {
  std::vector<double> sums(lags + 1, 0.0);
  std::vector<double> pairs(lags + 1, 0.0);
  for (const StillFixes& rest : rests) {
    for (std::size_t i = 0; i < rest.size(); ++i) {
      for (std::size_t j = i; j < rest.size(); ++j) {
        const auto lag = static_cast<std::size_t>(std::lround((rest[j].time_s - rest[i].time_s) / step_s));
        if (lag > lags) {
          break;
        }
        sums[lag] += rest[i].error_m.dot(rest[j].error_m);
        pairs[lag] += 1.0;
      }
    }
  }
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    sums[lag] /= std::max(pairs[lag], 1.0);
  }
  return sums;
}

}  // namespace

std::optional<RestCorrelation> rest_correlation(const Drive& drive) {
  RestCorrelation found;
  std::vector<StillFixes> rests;
  double longest_s = 0.0;
  for (std::size_t run = 0; run < drive.runs.size(); ++run) {
    for (const Rest& rest : rests_of(drive, run)) {
      const double length_s = rest.to_s - rest.from_s;
      StillFixes still = length_s < kLongRest ? StillFixes{} : fixes_in(drive, rest);
      if (!still.empty()) {
        rests.push_back(std::move(still));
        found.seconds += length_s;
        longest_s = std::max(longest_s, length_s);
      }
    }
  }
  found.rests = rests.size();
  if (rests.empty()) {
    return std::nullopt;
  }
  const double step_s = median_step(rests);
  if (!(step_s > 0.0) || step_s > kSparsestFixes) {
    return std::nullopt;
  }
  const auto lags = static_cast<std::size_t>(0.5 * longest_s / step_s);
  const std::vector<double> products = mean_products(rests, step_s, lags);
  if (!(products.front() > 0.0)) {
    return std::nullopt;
  }
  const auto correlation = [&](std::size_t lag) { return products[lag] / products.front(); };
  found.after_1s = correlation(static_cast<std::size_t>(std::lround(1.0 / step_s)));
  const double fallen = std::exp(-1.0);
  for (std::size_t lag = 1; lag <= lags && !found.lasts_s; ++lag) {
    if (correlation(lag) <= fallen) {
      const double above = correlation(lag - 1) - fallen;
      found.lasts_s = step_s * (static_cast<double>(lag - 1) + above / (correlation(lag - 1) - correlation(lag)));
    }
  }
  return found;
}

}  // namespace driftlab::drive
