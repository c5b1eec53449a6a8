#include "core/campaign/channel_closeness.hpp"

#include "core/fit/closeness.hpp"

namespace driftlab {

std::vector<std::optional<double>> distances_2p(const ReportedChannel& channel) {
  const std::size_t fitted = fitted_scales(channel.haar.scale, channel.dt_s, channel.from_tau_s);
  std::vector<RankedModel> models;
  models.reserve(channel.fits.size());
  for (const ReportedFit& fit : channel.fits) {
    models.push_back({fit.model, fit.wic});
  }
  return distances_2p(models, criterion_observations(channel.samples + channel.missing, channel.discrepancy, fitted));
}

}  // namespace driftlab
