#include "core/analysis/implied_curves.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr int kCurvePointsPerOctave = 8;
constexpr int kSpectrumPoints = 160;

std::vector<double> frequencies(double longest_s, double dt_s) {
  std::vector<double> grid;
  const double low = std::log(0.5 / longest_s);
  const double high = std::log(0.5 / dt_s);
  for (int i = 0; i < kSpectrumPoints; ++i) {
    grid.push_back(std::exp(low + (high - low) * i / (kSpectrumPoints - 1)));
  }
  return grid;
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) {
    value *= factor;
  }
}

void scale(std::vector<std::optional<double>>& values, double factor) {
  for (std::optional<double>& value : values) {
    value = value ? std::optional(*value * factor) : std::nullopt;
  }
}

MeasuredOverModel over_model(const Model& model, double factor, double dt_s, const MeasuredDeviation& measured) {
  std::vector<double> halves;
  for (const double tau_s : measured.tau_s) {
    halves.push_back(std::round(tau_s / dt_s));
  }
  MeasuredOverModel told{measured.tau_s, implied_curves(model, dt_s, halves, {}).deviation, {}, {}, {}};
  scale(told.deviation, factor);
  for (std::size_t i = 0; i < told.deviation.size(); ++i) {
    const double implied = told.deviation[i];
    const auto over = [implied](const std::optional<double>& value) {
      return value && implied > 0.0 ? std::optional(*value / implied) : std::nullopt;
    };
    told.ratio.push_back(over(measured.deviation[i]));
    told.low.push_back(over(measured.low[i]));
    told.high.push_back(over(measured.high[i]));
  }
  return told;
}

}  // namespace

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

ImpliedBeside implied_beside(const Model& model, const Unit& unit, double dt_s, const MeasuredDeviation& measured) {
  const double longest = measured.tau_s.back();
  const double factor = 1.0 / unit.factor;
  ImpliedBeside beside{implied_curves(model, dt_s, octave_grid(longest * 1.25 / dt_s, kCurvePointsPerOctave),
                                      frequencies(longest, dt_s)),
                       over_model(model, factor, dt_s, measured)};
  scale(beside.curves.deviation, factor);
  scale(beside.curves.density, factor * factor);
  for (ImpliedComponent& component : beside.curves.components) {
    scale(component.deviation, factor);
    scale(component.density, factor * factor);
  }
  return beside;
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
