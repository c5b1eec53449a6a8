#pragma once
/// How the error of position grows while fixes are withheld: statistics over the outages of one duration at even times
/// of them.
///
/// The slope of the curve says which error rules an outage, which the error at its end alone does not. While fixes are
/// withheld, the error of position grows with a power of the time: 5/2 under white noise of the rate, 3 under a
/// constant error of the gyroscope, 2 under one of the accelerometer, and 1 under an error of velocity at the start
/// (Groves 2013, section 5.7).
#include "core/navigate/drive/drive_outage.hpp"

#include <span>

namespace driftlab::drive {

/// Horizontal errors at kGrowthPoints times; all lists are as long. NaN where no outage has a reference.
struct ErrorGrowth {
  std::vector<double> time_s;      ///< after the outage's start; the last is its end
  std::vector<std::size_t> count;  ///< outages whose reference says where the vehicle was
  std::vector<double> rms_m, median_m;
  std::vector<double> p05_m, p95_m;  ///< the middle 90 % of the outages
};

/// Of outages that all last `duration_s`.
[[nodiscard]] ErrorGrowth growth_of(const std::vector<DriveOutage>& outages, double duration_s);

/// Statistics of errors. No list is empty.
[[nodiscard]] double root_mean_square(std::span<const double> values);
[[nodiscard]] double middle_of(std::vector<double> values);
/// The value that stands at `share` of the way through the sorted values, the nearest of them.
[[nodiscard]] double value_at_share(std::span<const double> sorted, double share);

}  // namespace driftlab::drive
