#pragma once
/// The use case "toy": recordings in, the mean reading of each of their channels out. It exists to be added by
/// tests/house/recipes_test.py.
#include "core/analysis/recording_source.hpp"

#include <string>
#include <vector>

namespace driftlab {

struct ToyMean {
  std::string recording;
  std::string channel;
  double mean = 0.0;  ///< in the channel's own unit
};

struct ToyReport {
  std::vector<ToyMean> means;
};

/// Errors, located: those of the source and of view_recording; Cancelled.
[[nodiscard]] Result<ToyReport> toy(RecordingSource& recordings, const RunControl& control = {});

}  // namespace driftlab
