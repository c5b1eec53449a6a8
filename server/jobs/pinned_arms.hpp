#pragma once
/// The recordings that a regression run compares, each pinned to the results that it is compared by when the run is
/// asked for: arms that name labels alone are completed, and so are the releases of earlier runs.
#include "server/jobs/compared_recordings.hpp"
#include "server/jobs/identified_causes.hpp"
#include "server/jobs/regression_memory.hpp"

namespace driftlab::server {

/// What is known of a device's recordings.
struct DeviceResults {
  ResultsByRecording results;
  CausesByRecording causes;
};

/// The `inputs` of a canonical request: `device`, `device_name`, `baseline`, `candidate`, `history` (that of the
/// request, or what the server remembers) and `excluded`, arms as {"label", "recordings": [{"recording", "revision",
/// "results", ...}]}. What the client must mend goes to `faults`. Errors: those of the store.
[[nodiscard]] Result<Json> pinned_inputs(WrittenRegression& written, const Device& device,
                                         const RegressionMemory& memory, const DeviceResults& known, Store& store,
                                         Faults& faults);

}  // namespace driftlab::server
