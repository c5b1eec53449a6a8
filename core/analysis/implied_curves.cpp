#include "core/analysis/implied_curves.hpp"

#include <cmath>

namespace driftlab {

ImpliedCurves implied_curves(const Model& model, double dt_s, std::span<const double> halves,
                             std::span<const double> f_hz) {
  ImpliedCurves curves;
  curves.f_hz.assign(f_hz.begin(), f_hz.end());
  std::vector<double> variance(halves.size(), 0.0);
  curves.density.assign(f_hz.size(), 0.0);
  for (const double half : halves) {
    curves.tau_s.push_back(half * dt_s);
  }
  for (const Process& process : model) {
    ImpliedComponent component{std::string(process.kind->name), {}, {}};
    for (std::size_t i = 0; i < halves.size(); ++i) {
      const double part = process.allan_variance(halves[i], dt_s);
      variance[i] += part;
      component.deviation.push_back(std::sqrt(part));
    }
    for (std::size_t i = 0; i < f_hz.size(); ++i) {
      const std::optional<double> part = process.spectral_density(f_hz[i], dt_s);
      std::optional<double>& sum = curves.density[i];
      sum = part && sum ? std::optional(*sum + *part) : std::nullopt;
      component.density.push_back(part);
    }
    curves.components.push_back(std::move(component));
  }
  for (const double one : variance) {
    curves.deviation.push_back(std::sqrt(one));
  }
  return curves;
}

std::vector<double> octave_grid(double largest, int per_octave) {
  std::vector<double> grid;
  for (int step = 0;; ++step) {
    const double m = std::round(std::exp2(static_cast<double>(step) / per_octave));
    if (m > largest) {
      return grid;
    }
    if (grid.empty() || m > grid.back()) {
      grid.push_back(m);
    }
  }
}

}  // namespace driftlab
