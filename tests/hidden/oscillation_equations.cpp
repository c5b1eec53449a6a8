/// The equations of oscillations that are no line, by another hand than their injections: inner products with the
/// oscillations that they should be made of.
#include "tests/hidden/equations.hpp"

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

}  // namespace

std::vector<Equation> oscillation_equations() {
  return {
      {"chirped_disturbance", {0.03, 3.0, 11.0}, chirped},
      {"modulated_disturbance", {0.03, 1.7, 0.03}, modulated},
  };
}

}  // namespace driftlab::hidden
