/// The equations of oscillations that are no line, of noise that jumps, and of a bias that turns with the sensor, by
/// another hand than their injections: inner products with the oscillations that they should be made of, and for what
/// is random its moments over many draws.
#include "tests/hidden/equations.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace driftlab::hidden {
namespace {

using investigate::Figure;
using Figures = std::vector<Figure>;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Amplitude of the part of what was added that follows a phase [in turns] in time.
double part(const Injected& injected, const std::function<double(double)>& turns) {
  const std::vector<double> added = injected.added();
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < added.size(); ++i) {
    sum += added[i] * std::polar(1.0, -kTurn * turns(static_cast<double>(i) * injected.dt_s()));
  }
  return 2.0 * std::abs(sum) / static_cast<double>(added.size());
}

double whole(const Injected& injected) {
  double square = 0.0;
  for (const double v : injected.added()) {
    square += v * v / static_cast<double>(injected.samples());
  }
  return square;
}

Figures chirped(const Injected& injected) {
  const double a = injected.values[0];
  const double f0 = injected.values[1];
  const double f1 = injected.values[2];
  const double seconds = static_cast<double>(injected.samples()) * injected.dt_s();
  return {{"amplitude along the run",
           part(injected, [&](double t) { return f0 * t + 0.5 * (f1 - f0) / seconds * t * t; }), a, 0.01 * a},
          {"mean square of the whole", whole(injected), 0.5 * a * a, 0.02 * a * a}};
}

Figures modulated(const Injected& injected) {
  const double a = injected.values[0];
  const double f = injected.values[1];
  const double fm = injected.values[2];
  const auto line = [&](double at) { return part(injected, [&](double t) { return at * t; }); };
  return {{"line of f0", line(f), 0.5 * a, 0.02 * a},
          {"line below", line(f - fm), 0.25 * a, 0.02 * a},
          {"line above", line(f + fm), 0.25 * a, 0.02 * a},
          {"mean square of the whole", whole(injected), 3.0 / 16.0 * a * a, 0.01 * a * a}};
}

Figures bursts(const Injected& injected) {
  constexpr std::uint64_t kDraws = 60;
  double loud = 0.0;
  double square = 0.0;
  double crossings = 0.0;
  double samples = 0.0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const investigate::Draft draft = injected.again(seed);
    double last = 0.0;
    for (std::size_t i = 0; i < draft.mean.size(); ++i) {
      const double added = draft.mean[i] - injected.before.mean[i];
      loud += added != 0.0 ? 1.0 : 0.0;
      square += added * added;
      crossings += added * last < 0.0 ? 1.0 : 0.0;
      last = added;
    }
    samples += static_cast<double>(draft.mean.size());
  }
  const double seconds = loud * injected.dt_s();
  const double a = injected.values[0];
  const double f = injected.values[1];
  const double share = injected.values[2];
  return {{"share of the time", loud / samples, share, 0.1 * share},
          {"rms in a burst", std::sqrt(square / loud), a, 0.05 * a},
          {"half the changes of sign per second", 0.5 * crossings / seconds, f, 0.03 * f}};
}

/// Two values, and a mean time between changes.
Figures telegraph(const Injected& injected) {
  constexpr std::uint64_t kDraws = 20;
  double changes = 0.0;
  double samples = 0.0;
  double off = 0.0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const investigate::Draft draft = injected.again(seed);
    double last = draft.mean[0] - injected.before.mean[0];
    for (std::size_t i = 0; i < draft.mean.size(); ++i) {
      const double added = draft.mean[i] - injected.before.mean[i];
      off = std::max(off, std::fabs(std::fabs(added) - injected.values[0]));
      changes += added * last < 0.0 ? 1.0 : 0.0;
      last = added;
      samples += 1.0;
    }
  }
  const double expected = samples * injected.dt_s() / injected.values[1];
  return {{"how far a value is from either level", off, 0.0, 1e-12},
          {"changes", changes, expected, 5.0 * std::sqrt(expected)}};
}

/// A damped oscillation that white noise drives: its variance, and its correlation e^-at [cos bt + (a/b) sin bt] over a
/// quarter and over a whole period, a = pi f/Q.
Figures resonance(const Injected& injected) {
  constexpr std::uint64_t kDraws = 10;
  const double a = 0.5 * kTurn * injected.values[1] / injected.values[2];
  const double b = std::sqrt(kTurn * injected.values[1] * kTurn * injected.values[1] - a * a);
  Figures figures;
  double square = 0.0;
  std::vector<double> products(2, 0.0);
  const std::vector<std::size_t> lags{2, 7};
  double samples = 0.0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const investigate::Draft draft = injected.again(seed);
    std::vector<double> x(draft.slow.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = draft.slow[i] - injected.before.slow[i];
      square += x[i] * x[i];
      samples += 1.0;
      for (std::size_t k = 0; k < lags.size(); ++k) {
        products[k] += i >= lags[k] ? x[i] * x[i - lags[k]] : 0.0;
      }
    }
  }
  const double sigma = injected.values[0];
  figures.push_back({"standard deviation", std::sqrt(square / samples), sigma, 0.02 * sigma});
  for (std::size_t k = 0; k < lags.size(); ++k) {
    const double t = static_cast<double>(lags[k]) * injected.dt_s();
    figures.push_back({"correlation over " + std::to_string(t) + " s", products[k] / square,
                       std::exp(-a * t) * (std::cos(b * t) + a / b * std::sin(b * t)), 0.02});
  }
  return figures;
}

/// A constant, that of the heading.
Figures of_heading(const Injected& injected) {
  const std::vector<double> added = injected.added();
  const auto [low, high] = std::minmax_element(added.begin(), added.end());
  const double expected = injected.values[0] * std::cos((motion::kHeadingDeg - injected.values[1]) / 360.0 * kTurn);
  return {{"bias", added.front(), expected, 1e-12}, {"change within the recording", *high - *low, 0.0, 1e-12}};
}

}  // namespace

std::vector<Equation> oscillation_equations() {
  return {
      {"resonance", {0.02, 7.0, 5.0}, {"y", "1/s", "1"}, resonance},
      {"heading_dependent_bias", {0.02, 40.0}, {"y", "deg"}, of_heading},
      {"random_telegraph_noise", {0.02, 10.0}, {"y", "s"}, telegraph},
      {"chirped_disturbance", {0.03, 3.0, 11.0}, {"y", "1/s", "1/s"}, chirped},
      {"modulated_disturbance", {0.03, 1.7, 0.03}, {"y", "1/s", "1/s"}, modulated},
      {"vibration_bursts", {0.05, 7.0, 0.15}, {"y", "1/s", "1"}, bursts},
  };
}

}  // namespace driftlab::hidden
