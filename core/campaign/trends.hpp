#pragma once
/// How one parameter of the error model depends on the dynamics: on |rate| or on |angular acceleration|, from its
/// estimates under several conditions.
///
/// Model. Error parameters are positive, so their logarithms are their scale. With value_i the estimate under condition
/// i and w_i the size of its rate or acceleration
///   y_i = ln value_i = ln f(w_i) + u_i + e_i.
/// e_i is the error of the estimate, Gaussian with the standard deviation that its interval states. u_i is what differs
/// between conditions for reasons that w does not explain, with a standard deviation tau that is estimated. Three
/// questions are asked:
///
/// - Do the conditions differ at all? Cochran's Q of the y_i about their weighted mean has, if they do not (and
///   tau = 0), a chi-square law with n - 1 degrees of freedom (Cochran 1954).
/// - Does the parameter rise or fall with w? y is regressed on the rank of w, with weights, tau by Paule and Mandel
///   (1982). The slope is tested by Student's t with n - 2 degrees of freedom and the variance of Knapp and Hartung
///   (2003), which is never taken below the one that the intervals imply. Conditions that merely differ at random are
///   thereby no trend. Two or three conditions cannot tell such differences from a trend: the test is then the normal
///   one of the estimates themselves, and `few` says so.
/// - Which relation describes it? Constant f = a, linear f = a + b w, or power f = a + b w^c, whichever has the
///   smallest AICc, the criterion for small samples of Hurvich and Tsai (1989). tau is fitted with each and counted
///   with none. Below four points the choice is between constant and linear, and the first test makes it.
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
