#pragma once
/// Deviations of variances, with their intervals.
///
/// The root is monotone, so the ends of an interval of the variance are those of the deviation. An interval of a
/// variance may reach below 0, where an estimate scatters about little; a deviation does not.
#include "core/signal/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab {

/// [unit] of a variance [unit^2]; NaN below 0, which no estimate is.
[[nodiscard]] inline double deviation_of(double variance) { return std::sqrt(variance); }

/// The ends of the interval, those below 0 as 0.
[[nodiscard]] inline Interval deviation_of(const Interval& variance) {
  return {std::sqrt(std::max(variance.low, 0.0)), std::sqrt(std::max(variance.high, 0.0))};
}

/// A curve of variances as it is read: deviations against averaging time.
struct DeviationCurve {
  std::vector<double> tau_s;
  std::vector<double> deviation;  ///< [unit of the samples]
  std::vector<Interval> ci95;     ///< of the deviation
  std::vector<double> edf;        ///< equivalent degrees of freedom of each variance
};

/// Of an Allan curve (core/fit/characterisation.hpp), or of what estimates one at the longest tau
/// (core/variance/long_tau.hpp): whatever has tau_s, variance, ci95 and edf, one of each per tau.
template <class Curve>
[[nodiscard]] DeviationCurve deviations_of(const Curve& curve) {
  DeviationCurve told{curve.tau_s, {}, {}, curve.edf};
  for (std::size_t i = 0; i < curve.tau_s.size(); ++i) {
    told.deviation.push_back(deviation_of(curve.variance[i]));
    told.ci95.push_back(deviation_of(curve.ci95[i]));
  }
  return told;
}

/// Of a surface of variances, row by row.
[[nodiscard]] inline std::vector<std::vector<double>> deviations_of(const std::vector<std::vector<double>>& variances) {
  std::vector<std::vector<double>> rows;
  for (const std::vector<double>& variance : variances) {
    std::vector<double>& row = rows.emplace_back();
    for (const double one : variance) {
      row.push_back(deviation_of(one));
    }
  }
  return rows;
}

}  // namespace driftlab
