#pragma once
/// The populations of a model (core/campaign/population_report.hpp) from stored results.
#include "core/campaign/population_report.hpp"
#include "server/store/store.hpp"

#include <optional>
#include <string>

namespace driftlab::server {

/// Of every device that the store shows. `quantity`: only that sensor. Errors: NotFound (no device is of the model);
/// those of the store. Cost: some ms a device.
[[nodiscard]] Result<PopulationReport> stored_populations(Store& store, const std::string& model,
                                                          std::optional<Quantity> quantity);

}  // namespace driftlab::server
