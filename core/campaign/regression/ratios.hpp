#pragma once
/// What a regression run tells as ratios. Its comparisons are made on logarithms of Allan deviations, which have an
/// even scatter at every averaging time; people read candidate over baseline.
#include "core/campaign/regression/report.hpp"

namespace driftlab::regression {

/// Candidate over baseline, 1: no change.
struct RatioReport {
  double ratio = 1.0;
  Interval ci95 = {1.0, 1.0};  ///< of all tests at once
  double upper_single = 1.0;   ///< upper end of this test alone
  double margin = 1.0;         ///< the most that is accepted
  /// Allan deviations of baseline and candidate [SI], each with the 95 % interval of this arm and scale alone. Of a
  /// scale.
  std::optional<std::array<Estimate, 2>> deviations = {};
};
[[nodiscard]] RatioReport ratios_of(const ScaleReport& told);

/// How far a ratio is from 1 [%]: 1.1 is 10.
[[nodiscard]] inline double change_percent(double ratio) { return 100.0 * (ratio - 1.0); }

/// A trend over releases.
struct TrendRatios {
  double per_release = 1.0;
  Interval ci95 = {1.0, 1.0};
  double total = 1.0;  ///< from the anchor to the candidate
};
[[nodiscard]] TrendRatios ratios_of(const ReleaseTrend& trend);

/// By how much sessions of one sensor scatter: root mean squares of the factors of session_scatter.hpp, with the grid
/// points between which 95 % of their posterior lies.
struct ScatterFactors {
  Estimate common;
  Estimate local;
};
[[nodiscard]] ScatterFactors factors_of(const SessionScatter& scatter);

}  // namespace driftlab::regression
