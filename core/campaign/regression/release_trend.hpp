#pragma once
/// A drift over releases that no comparison of two of them sees (spec/regression.md, section 8).
///
/// Per unit, the means of the releases' sessions, x_l over the rows to `through_s`, are regressed on the release order:
/// x_l = a + b t_l 1 + error, one slope b for all rows and a level of its own for each, by generalised least squares
/// with the covariance of the means, C_l = sum_r w_r w_r' (S_r/4 + K). The level N of white noise is regressed alike,
/// as the linear function of the rows that make_contrast() found, where the structure of the unit holds.
///
/// p and interval are those of a normal slope, mixed over the posterior of the factors (kL, kS) of K. Sessions with
/// heavier tails than normal ones average out over the releases; the measured share of false warnings is in
/// tests/ACCURACY.md.
#include "core/campaign/regression/contrast.hpp"
#include "core/signal/estimate.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab::regression {

/// Releases on a line: `position[s]` is that of session s. The anchor is where the total is counted from.
struct ReleaseOrder {
  std::vector<double> position;
  double anchor = 0.0;
  double candidate = 0.0;
};

struct ReleaseTrend {
  std::size_t unit = 0;
  std::optional<std::size_t> level;  ///< of the unit; empty: the scales to `through_s`
  std::size_t releases = 0;
  double slope = 0.0;  ///< [ln deviation per release]
  Interval ci95 = {0.0, 0.0};
  double total = 0.0;  ///< from the anchor to the candidate [ln deviation]
  double p = 1.0;      ///< that there is no slope
};

/// From here on a trend is a warning.
inline constexpr double kTrendWarning = 0.01;

/// Units with three releases or more that reach the same rows, in the order of the units, scales before N. Sessions of
/// a release that lack a row are left out of it; rows that a release lacks altogether are left out of the regression.
[[nodiscard]] std::vector<ReleaseTrend> release_trends(const Design& design, const ScatterTerms& terms,
                                                       const SessionScatter& scatter, const Contrast& contrast,
                                                       const ReleaseOrder& order, double through_s);

}  // namespace driftlab::regression
