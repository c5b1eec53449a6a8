#include "core/fit/closeness.hpp"

#include "core/process/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {

double criterion_observations(std::size_t grid_samples, double discrepancy, std::size_t scales) {
  return static_cast<double>(discrepancy > 0.0 ? scales : grid_samples);
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
