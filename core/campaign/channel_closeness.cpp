#include "core/campaign/channel_closeness.hpp"

#include "core/fit/closeness.hpp"

#include <algorithm>

namespace driftlab {

std::vector<std::optional<double>> distances_2p(const ReportedChannel& channel) {
  constexpr double kRounding = 1e-9;
  const auto fitted = std::count_if(channel.haar.scale.begin(), channel.haar.scale.end(), [&](std::size_t scale) {
    const std::size_t averaged = scale / 2;  // samples: tau of the scale
    return static_cast<double>(averaged) * channel.dt_s >= channel.from_tau_s * (1.0 - kRounding);
  });
  std::vector<RankedModel> models;
  models.reserve(channel.fits.size());
  for (const ReportedFit& fit : channel.fits) {
    models.push_back({fit.model, fit.wic});
  }
  return distances_2p(models, criterion_observations(channel.samples + channel.missing, channel.discrepancy,
                                                     static_cast<std::size_t>(fitted)));
}

}  // namespace driftlab
