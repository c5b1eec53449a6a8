#pragma once
/// Which devices of a characterisation are not of the line of their model.
#include "server/store/store.hpp"

namespace driftlab::server {

/// Adds to `results.verdicts`, of each device and each model that it states, that it stands out among the devices of
/// the model, or that no more is to be said of it (a verdict without words). Models of 4 to 200 devices: of fewer none
/// is told, and of more each characterisation would read for seconds. Errors: those of the store.
[[nodiscard]] Status add_line_verdicts(Store& store, JobResults& results);

}  // namespace driftlab::server
