#pragma once
/// The populations of a model (core/analysis/compare_devices.hpp) from stored results.
#include "core/analysis/compare_devices.hpp"
#include "server/store/store.hpp"

#include <optional>
#include <string>

namespace driftlab::server {

/// Of every device that the store shows. `quantity`: only that sensor. Errors: NotFound (no device is of the model);
/// those of the store. Cost: some ms a device.
[[nodiscard]] Result<PopulationReport> stored_populations(Store& store, const std::string& model,
                                                          std::optional<Quantity> quantity);

}  // namespace driftlab::server
