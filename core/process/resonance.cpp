#include "core/process/resonance.hpp"

#include "core/process/damped_oscillation.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {
namespace {

DampedOscillation unit_of(const Resonance& process, double dt_s) {
  return {kTurn * process.frequency_hz * dt_s, process.quality};
}

/// The share of the natural frequency up to which the density is within a tenth of that at zero: the first root of
/// 1 + v (1/Q^2 - 2) + v^2 = 1/0.9 or 1/1.1 in v = u^2.
double flat_share(double quality) {
  const double linear = 1.0 / (quality * quality) - 2.0;
  double first = std::numeric_limits<double>::infinity();
  for (const double level : {1.0 / 0.9, 1.0 / 1.1}) {
    const double discriminant = 0.25 * linear * linear - (1.0 - level);
    if (discriminant >= 0.0) {
      for (const double root : {-0.5 * linear - std::sqrt(discriminant), -0.5 * linear + std::sqrt(discriminant)}) {
        first = root > 0.0 ? std::min(first, root) : first;
      }
    }
  }
  return std::sqrt(first);
}

}  // namespace

double Resonance::haar_variance(double m, double dt_s) const {
  return sigma * sigma * unit_of(*this, dt_s).haar_variance(m);
}

void Resonance::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const DampedOscillation unit = unit_of(*this, dt_s);
  const DampedOscillation::Slope slope = unit.haar_slope(m);
  out[0] = 2.0 * sigma * unit.haar_variance(m);
  out[1] = sigma * sigma * slope.by_rate * kTurn * dt_s;
  out[2] = sigma * sigma * slope.by_quality;
}

void Resonance::haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                           std::span<double> gradient) const {
  const double square = sigma * sigma;
  const double turn = kTurn * dt_s;
  unit_of(*this, dt_s).each_haar(half, [&](std::size_t j, double unit, const DampedOscillation::Slope& slope) {
    variance[j] = square * unit;
    if (!gradient.empty()) {
      gradient[3 * j] = 2.0 * sigma * unit;
      gradient[3 * j + 1] = square * slope.by_rate * turn;
      gradient[3 * j + 2] = square * slope.by_quality;
    }
  });
}

std::optional<double> Resonance::spectral_density(double f_hz, double dt_s) const {
  return sigma * sigma * dt_s * unit_of(*this, dt_s).density(f_hz * dt_s);
}

LowFrequencyDensity Resonance::low_frequency(double dt_s) const {
  return {sigma * sigma * dt_s * unit_of(*this, dt_s).density_at_zero(), frequency_hz * flat_share(quality)};
}

std::optional<double> Resonance::autocovariance(double lag, double dt_s) const {
  return sigma * sigma * unit_of(*this, dt_s).autocovariance(lag);
}

double Resonance::variogram(double lag, double dt_s) const {
  return sigma * sigma * unit_of(*this, dt_s).variogram(lag);
}

void Resonance::add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                               std::span<double> out) const {
  unit_of(*this, dt_s).add_haar_cross(mi, mj, lags, factor * sigma * sigma, out);
}

Ringing Resonance::ringing(double dt_s) const { return unit_of(*this, dt_s).ringing(); }

std::optional<StateSpace> Resonance::state_space(double dt_s) const {
  return unit_of(*this, dt_s).state_space(sigma * sigma);
}

void Resonance::add_path(Random& random, double dt_s, std::span<double> out) const {
  unit_of(*this, dt_s).add_path(sigma, random, out);
}

}  // namespace driftlab
