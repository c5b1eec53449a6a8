#pragma once
/// Whether recordings that somebody puts beside each other have one structure, by the test that the conditions of one
/// device undergo (core/campaign/structure.hpp).
#include "core/campaign/pooled_sensor.hpp"
#include "core/campaign/reported_channel.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// One recording's channel with its fits.
struct FittedRow {
  std::string label;
  std::vector<ReportedFit> fits;
};

/// Whether one structure serves all rows, of which there is at least one, by the candidates that all of them were
/// fitted with. The sentence speaks of recordings.
[[nodiscard]] PooledStructure compare_structures(const std::vector<FittedRow>& rows);

}  // namespace driftlab
