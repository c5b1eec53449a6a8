#include "core/fit/closeness.hpp"

#include "core/process/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {

double criterion_observations(std::size_t grid_samples, double discrepancy, std::size_t scales) {
  return static_cast<double>(discrepancy > 0.0 ? scales : grid_samples);
}

std::size_t fitted_scales(std::span<const std::size_t> scale, double dt_s, double from_tau_s) {
  constexpr double kRounding = 1e-9;
  return static_cast<std::size_t>(std::count_if(scale.begin(), scale.end(), [&](std::size_t samples) {
    const std::size_t averaged = samples / 2;  // tau of the scale
    return static_cast<double>(averaged) * dt_s >= from_tau_s * (1.0 - kRounding);
  }));
}

std::vector<std::optional<double>> distances_2p(std::span<const RankedModel> models, double observations) {
  std::vector<std::optional<double>> distances;
  double least = std::numeric_limits<double>::infinity();
  for (const RankedModel& one : models) {
    std::optional<double>& distance = distances.emplace_back();
    const auto structure = parse_model(one.model);
    if (structure && std::isfinite(one.criterion)) {
      const auto parameters = static_cast<double>(structure->parameter_count());
      distance = one.criterion + parameters * (2.0 - std::log(observations));
      least = std::min(least, *distance);
    }
  }
  for (std::optional<double>& distance : distances) {
    distance = distance ? std::optional(*distance - least) : std::nullopt;
  }
  return distances;
}

}  // namespace driftlab
