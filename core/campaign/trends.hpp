#pragma once
/// How one parameter moves with the dynamics: against |rate| or |angular acceleration|, over the conditions in which it
/// was estimated.
///
/// Model: y_i = ln value_i = ln f(w_i) + u_i + e_i, e_i Gaussian with the standard deviation of the estimate's
/// interval, u_i a spread between conditions that the relation does not explain (standard deviation tau, estimated).
/// All error parameters are positive, so logarithms are their scale. Three questions, three answers:
///
/// - Does it move at all? Cochran's Q over the weighted mean, chi-square(n - 1) (Cochran 1954), tau = 0 under the
///   hypothesis.
/// - Is there a monotone trend? Weighted regression of y on the rank of w, tau by Paule and Mandel (1982), t(n - 2)
///   with the variance of Knapp and Hartung (2003), never below the one that the intervals imply: conditions that
///   differ at random are no trend. With two or three conditions the spread cannot be told from a trend; the test is
///   then the normal one of the estimates themselves, and `few` says so.
/// - Which relation? constant f = a, linear f = a + b w, power f = a + b w^c, by the small-sample criterion AICc
///   (Hurvich and Tsai 1989), tau a nuisance of all alike and not counted; below 4 points constant or linear, by the
///   first test.
///
/// Measured size, power and coverage: tests/ACCURACY.md.
#include "core/process/distributions.hpp"
#include "core/signal/estimate.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace driftlab {

/// The parameter under one condition. `ci95` must be closed and positive.
struct TrendPoint {
  double at = 0.0;  ///< |rate| or |angular acceleration|, any unit
  Estimate estimate;
};

enum class Relation { Constant, Linear, Power };

/// `constant`, `linear`, `power`.
[[nodiscard]] std::string_view name_of(Relation relation);

/// f between the smallest and the largest `at`: value `low` at 0, `high` at `scale`, exponent between.
/// f(w) = low + (high - low) (w/scale)^exponent; constant: low = high.
struct FittedRelation {
  Relation relation = Relation::Constant;
  double low = 0.0;
  double high = 0.0;
  double exponent = 1.0;
  double scale = 1.0;   ///< the largest `at`
  double spread = 0.0;  ///< tau: standard deviation of ln value about the relation that intervals do not explain
  double aicc = 0.0;
  /// Covariance of (ln low, ln high, ln exponent), row by row; entries of absent parameters are 0.
  double covariance[3][3] = {};
  double quantile = kNormal975;  ///< of the 95 % interval: Student's t where the spread was estimated

  [[nodiscard]] double operator()(double at) const;
};

struct Trend {
  std::vector<TrendPoint> points;  ///< rising `at`
  double equal_statistic = 0.0;
  double equal_p = 1.0;  ///< that all conditions share one value
  double monotone_statistic = 0.0;
  double monotone_p = 1.0;
  bool few = false;   ///< two or three points: see above
  int direction = 0;  ///< +1 or -1 where the monotone test rejects at 5 %, else 0
  FittedRelation relation;
  std::vector<FittedRelation> candidates;  ///< every relation that n points allow

  [[nodiscard]] std::size_t equal_dof() const { return points.size() - 1; }
};

/// Errors: TooFewSamples (fewer than two points at different `at`), InvalidArgument (an interval that is open or not
/// positive).
[[nodiscard]] Result<Trend> fit_trend(std::vector<TrendPoint> points);

/// A parameter at a condition that was not measured, by the relation.
struct Interpolated {
  Estimate estimate;     ///< interval: of the parameter there, spread included
  bool outside = false;  ///< `at` is beyond the measured range, and the value is that of its end
};
[[nodiscard]] Interpolated value_at(const Trend& trend, double at);

}  // namespace driftlab
