#pragma once
/// The populations of a model (core/analysis/compare_devices.hpp) from stored results.
#include "core/analysis/compare_devices.hpp"
#include "server/store/store.hpp"

#include <optional>
#include <span>
#include <string>

namespace driftlab::server {

/// Of every device that the store shows. `quantity`: only that sensor. Errors: NotFound (no device is of the model);
/// those of the store. Cost: some ms a device.
[[nodiscard]] Result<PopulationReport> stored_populations(Store& store, const std::string& model,
                                                          std::optional<Quantity> quantity);

/// The populations as they are once `fresh` is stored, which takes the place of older results of the same recordings:
/// of the sensor axes that it has, of a model with at least `fewest` and at most `most` devices. Nothing for any other
/// model. Errors: those of the store.
[[nodiscard]] Result<std::optional<PopulationReport>> populations_with(Store& store, const std::string& model,
                                                                       std::span<const ChannelResult> fresh,
                                                                       std::size_t fewest, std::size_t most);

}  // namespace driftlab::server
