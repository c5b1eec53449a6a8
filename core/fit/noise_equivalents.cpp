#include "core/fit/noise_equivalents.hpp"

#include "core/process/registry.hpp"
#include "core/signal/angle.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

namespace driftlab {
namespace {

constexpr double kDegrees = 1.0 / kDegree;  ///< in one radian

/// Symbols of the channel's own unit in the conventions below.
struct Symbols {
  std::string_view density;        ///< SI density
  std::string_view small_density;  ///< as data sheets print it
  double small = 1.0;              ///< per SI
  std::string_view level;          ///< of one sample
  double level_factor = 1.0;
  std::string_view walk_density;
};

Symbols symbols_of(Dimension channel) {
  if (channel == Dimension::AngularRate) {
    return {"rad/s/sqrt(Hz)", "deg/s/sqrt(Hz)", kDegrees, "deg/s", kDegrees, "rad/s^2/sqrt(Hz)"};
  }
  if (channel == Dimension::SpecificForce) {
    return {"m/s^2/sqrt(Hz)", "ug/sqrt(Hz)", 1e6 / kStandardGravity, "mg", 1e3 / kStandardGravity, "m/s^3/sqrt(Hz)"};
  }
  return {"1/sqrt(Hz)", "1/sqrt(Hz)", 1.0, "1", 1.0, "1/s/sqrt(Hz)"};
}

NoiseEquivalent lab(Dimension channel, int second_power_halves) {
  const ParameterUnit unit = lab_unit(channel, second_power_halves);
  return {"ieee_952", unit.symbol, unit.per_si};
}

}  // namespace

std::vector<NoiseEquivalent> white_noise_equivalents(Dimension channel, double dt_s) {
  const Symbols symbols = symbols_of(channel);
  return {lab(channel, 1),
          {"density_two_sided", std::string(symbols.small_density), symbols.small},
          {"density_one_sided", std::string(symbols.small_density), symbols.small * std::numbers::sqrt2},
          {"kalibr_noise_density", std::string(symbols.density), 1.0},
          {"per_sample", std::string(symbols.level), symbols.level_factor / std::sqrt(dt_s)}};
}

std::vector<NoiseEquivalent> random_walk_equivalents(Dimension channel, double dt_s) {
  const Symbols symbols = symbols_of(channel);
  return {lab(channel, -1),
          {"kalibr_random_walk", std::string(symbols.walk_density), 1.0},
          {"step_per_sample", std::string(symbols.level), symbols.level_factor * std::sqrt(dt_s)}};
}

std::vector<LevelEquivalents> level_equivalents(const ModelFit& fit, Dimension channel, double dt_s) {
  std::vector<LevelEquivalents> levels;
  for (const FittedProcess& process : fit.processes) {
    const FittedParameter& level = process.parameters.front();
    const bool white = process.kind->white_square != nullptr;
    if (level.estimate && (white || process.kind == find_process("random_walk"))) {
      levels.push_back({std::string(level.declared->name), *level.estimate,
                        white ? white_noise_equivalents(channel, dt_s) : random_walk_equivalents(channel, dt_s)});
    }
  }
  return levels;
}

}  // namespace driftlab
