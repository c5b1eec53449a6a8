#pragma once
/// Several error models as filters on one recorded drive: what Radi, Nassar and El-Sheimy (2017) did once (section 4),
/// with the verdict that the data allow.
///
/// Every filter runs over the same readings and fixes and loses the same fixes, so that errors are compared outage by
/// outage under the same motion. With a_i and b_i the horizontal errors of two filters at the end of outage i, the
/// difference is mean(a) - mean(b) and the relative one mean(a)/mean(b) - 1. Outages of different phases overlap, so
/// that intervals come from a bootstrap over blocks of one period, in which all phases and both filters stay together;
/// one set of resamples serves every pair.
///
/// A difference is shown if the whole 95 % interval of the relative one lies on one side of 0. Else the interval says
/// how large it can be at most: "no difference larger than x % is shown". Every interval holds 95 % by itself; of many
/// pairs some exclude 0 by chance.
///
/// The noise level of a model is mostly characterised at rest, so that on the road every model states too small an
/// error. On request the white noise of each model is first scaled, separately for gyroscope and accelerometer, to the
/// level at which the innovations fit best (explain.hpp); the scale is the same in all bands of a model that follows
/// the rate.
#include "core/navigate/drive/evaluation.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab::drive {

/// The error model that a filter uses, with its name.
struct BelievedModel {
  std::string name;
  std::string about;
  ImuModel imu;
};

struct ComparedFilter {
  std::string name, about;
  double gyro_noise = 1.0, force_noise = 1.0;  ///< factors that the white noise was scaled by
  std::vector<DurationSummary> durations;
};

/// `filter` minus `against` over the outages of one duration.
struct FilterDifference {
  double duration_s = 0.0;
  std::size_t count = 0;  ///< outages
  std::string filter, against;
  Estimate difference_m;  ///< of the mean errors
  Estimate relative;
  bool bounded = false;  ///< there are enough blocks for an interval
  [[nodiscard]] bool shown() const { return bounded && !relative.ci95.contains(0.0); }
};

struct FilterComparison {
  std::vector<ComparedFilter> filters;        ///< in the order asked for
  std::vector<FilterDifference> differences;  ///< by duration; each filter against every one before it
  std::vector<std::string> notes;

  /// Nothing where a name or the duration is missing.
  [[nodiscard]] const FilterDifference* difference(std::string_view filter, std::string_view against,
                                                   double duration_s) const;
};

struct ComparisonOptions {
  std::uint64_t seed = 1;
  int resamples = 500;
  bool fit_noise = false;  ///< scale the white noise of each to the innovations first
};

/// `drive`'s own model is not used. Errors: InvalidArgument (fewer than two models, two of one name); those of
/// evaluate_drive; Cancelled.
[[nodiscard]] Result<FilterComparison> compare_filters(const Drive& drive, const std::vector<BelievedModel>& models,
                                                       const FilterOptions& options,
                                                       const ComparisonOptions& settings = {},
                                                       const RunControl& control = {});

/// One sentence for each duration on what is shown against the first filter, and how large a difference can be that is
/// not shown.
[[nodiscard]] std::vector<std::string> verdicts_of(const FilterComparison& comparison);

}  // namespace driftlab::drive
