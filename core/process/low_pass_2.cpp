#include "core/process/low_pass_2.hpp"

#include "core/process/damped_oscillation.hpp"
#include "core/signal/turns.hpp"

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

DampedOscillation unit_of(const LowPass2& process, double dt_s) {
  return {kTurn * process.corner_hz * dt_s, std::numbers::sqrt2 / 2.0};
}

}  // namespace

double LowPass2::sample_variance(double dt_s) const { return n * n / (dt_s * unit_of(*this, dt_s).density_at_zero()); }

double LowPass2::haar_variance(double m, double dt_s) const {
  return sample_variance(dt_s) * unit_of(*this, dt_s).haar_variance(m);
}

void LowPass2::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const DampedOscillation unit = unit_of(*this, dt_s);
  const double density = unit.density_at_zero();
  const double level = n * n / (dt_s * density);
  const double variance = unit.haar_variance(m);
  const double slope = unit.haar_slope(m).by_rate - variance * unit.density_slope_at_zero().by_rate / density;
  out[0] = 2.0 * level * variance / n;
  out[1] = level * slope * kTurn * dt_s;
}

std::optional<double> LowPass2::spectral_density(double f_hz, double dt_s) const {
  const DampedOscillation unit = unit_of(*this, dt_s);
  return n * n * unit.density(f_hz * dt_s) / unit.density_at_zero();
}

/// 1/(1 + u^4) is 1 - 1/10 at u = 9^(-1/4).
LowFrequencyDensity LowPass2::low_frequency(double /*dt_s*/) const { return {n * n, corner_hz / std::sqrt(3.0)}; }

std::optional<double> LowPass2::autocovariance(double lag, double dt_s) const {
  return sample_variance(dt_s) * unit_of(*this, dt_s).autocovariance(lag);
}

double LowPass2::variogram(double lag, double dt_s) const {
  return sample_variance(dt_s) * unit_of(*this, dt_s).variogram(lag);
}

void LowPass2::add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                              std::span<double> out) const {
  unit_of(*this, dt_s).add_haar_cross(mi, mj, lags, factor * sample_variance(dt_s), out);
}

Ringing LowPass2::ringing(double dt_s) const { return unit_of(*this, dt_s).ringing(); }

std::optional<StateSpace> LowPass2::state_space(double dt_s) const {
  return unit_of(*this, dt_s).state_space(sample_variance(dt_s));
}

void LowPass2::add_path(Random& random, double dt_s, std::span<double> out) const {
  unit_of(*this, dt_s).add_path(std::sqrt(sample_variance(dt_s)), random, out);
}

}  // namespace driftlab
