#pragma once
/// Did gross errors become more frequent? Bursts of one channel per session, before and after.
///
/// p is the probability that the candidate's rate is at most `times` the baseline's. Both rates are gamma distributed
/// after counts that are divided by their own scatter over the sessions: chi-square over degrees of freedom within the
/// arms, with the weight of four degrees of freedom put on 2, and at least 1 (spec/regression.md, section 7).
#include <vector>

namespace driftlab::regression {

/// Bursts of gross errors of one unit per session of an arm.
struct ErrorCounts {
  std::vector<double> errors;
  std::vector<double> hours;

  [[nodiscard]] double sum() const;
  [[nodiscard]] double time_h() const;
};

/// p as above; both arms have at least one session of positive length.
[[nodiscard]] double error_rate_p(const ErrorCounts& baseline, const ErrorCounts& candidate, double times);

/// P(X <= x) for X beta distributed with a, b > 0, by its continued fraction (Lentz; Abramowitz and Stegun 26.5.8).
[[nodiscard]] double beta_probability(double x, double a, double b);

}  // namespace driftlab::regression
