#include "core/fit/linear_states.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kWhiteFloor = 1e-6;

}  // namespace

double LinearStates::leave_one_out_variance() const {
  // Midpoints of a grid that is fine where slow states have their density: f = (u - sin(2 pi u)/(2 pi))/2 pushes points
  // towards 0 with cubic spacing.
  constexpr int kPoints = 400;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double u = (i + 0.5) / kPoints;
    const double phase = std::numbers::pi * u * u;  // 2 pi f, f from 0 to 1/2; df = u du
    const double s = std::sin(0.5 * phase);
    double density = white + 4.0 * error * s * s;
    for (int k = 0; k < count - (quantization ? 1 : 0); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double gap = 1.0 - transition[at];
      const double size = gap * gap + 4.0 * transition[at] * s * s;
      density += noise[at] > 0.0 ? noise[at] / size : 0.0;
    }
    sum += 2.0 * u / density;
  }
  return kPoints / sum;
}

std::optional<LinearStates> linear_states(const Model& model, double dt_s, double level_variance) {
  LinearStates states;
  states.count = 1;
  states.transition[0] = 1.0;
  states.start[0] = level_variance;
  for (const Process& process : model) {
    const auto form = process.state_space(dt_s);
    if (!form) {
      return std::nullopt;
    }
    const auto& symbol = process.kind->symbol;
    if (symbol == "WN") {
      states.white += process.autocovariance(0.0, dt_s).value_or(0.0);
    } else if (symbol == "QN") {
      states.quantization = true;
      states.error = 0.5 * process.autocovariance(0.0, dt_s).value_or(0.0);
    } else if (symbol == "RW") {
      states.noise[0] += form->q(0, 0);
    } else if (symbol == "GM" && states.count < LinearStates::kMost) {
      const auto k = static_cast<std::size_t>(states.count++);
      states.transition[k] = form->phi(0, 0);
      states.noise[k] = form->q(0, 0);
      states.start[k] = form->cov0(0, 0);
    } else {
      return std::nullopt;
    }
  }
  if (states.quantization) {
    if (states.count == LinearStates::kMost) {
      return std::nullopt;
    }
    const auto k = static_cast<std::size_t>(states.count++);
    states.noise[k] = states.error;
    states.start[k] = states.error;
  }
  double others = states.error;
  for (int k = 0; k < states.count; ++k) {
    others += states.noise[static_cast<std::size_t>(k)];
  }
  states.white = std::max(states.white, kWhiteFloor * others);
  if (!(states.white > 0.0)) {
    return std::nullopt;
  }
  return states;
}

}  // namespace driftlab
