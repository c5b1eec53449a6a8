#pragma once
/// The distributions behind intervals and tests.
///
/// Each function is one call of Boost.Math, compiled in distributions.cpp alone. Degrees of freedom are positive and
/// need not be whole. Arguments outside a function's domain give NaN or infinity; nothing throws.

namespace driftlab {

/// P(X > x) for standard normal X.
[[nodiscard]] double normal_tail(double x);
/// The x with P(X <= x) = 0.975 for standard normal X.
inline constexpr double kNormal975 = 1.959963984540054;
/// The x with P(X <= x) = p for standard normal X; 0 < p < 1.
[[nodiscard]] double normal_quantile(double p);
/// Density of the standard normal distribution.
[[nodiscard]] double normal_density(double x);

/// P(X > x) for X chi-squared with `dof` degrees of freedom; 1 below zero.
[[nodiscard]] double chi_squared_tail(double x, double dof);
/// The x with P(X <= x) = p for X chi-squared with `dof` degrees of freedom.
[[nodiscard]] double chi_squared_quantile(double p, double dof);

/// P(T > t) for T of Student's distribution with `dof` degrees of freedom.
[[nodiscard]] double student_tail(double t, double dof);
/// The t with P(T <= t) = p for T of Student's distribution with `dof` degrees of freedom.
[[nodiscard]] double student_quantile(double p, double dof);

/// Mean and variance of ln X for X gamma with shape x > 0 and scale 1: digamma and trigamma of x.
[[nodiscard]] double digamma(double x);
[[nodiscard]] double trigamma(double x);
/// ln Gamma(x) for x > 0; unlike std::lgamma without a global sign, so that threads may share it.
[[nodiscard]] double log_gamma(double x);

}  // namespace driftlab
