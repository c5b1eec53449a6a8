#pragma once
/// What a regression run is told of a recording beside its samples: temperature, full scales and causes that an
/// investigation identified. The same members in run.json, in a gate's state file and in a job.
#include "core/campaign/regression/recordings.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

struct StatedFacts {
  std::optional<double> temperature_degc;
  regression::FullScales full_scale;               ///< written in deg/s and g
  std::optional<std::vector<std::string>> causes;  ///< nothing: not investigated; empty: no cause was found

  /// True if no fact is stated.
  [[nodiscard]] bool empty() const;
  /// Adds causes that stored investigations found.
  void add_causes(const std::set<std::string>& found);
  void tell(regression::ComparedRecording& recording) const;
};

/// Whether a member of a recording is one of these.
[[nodiscard]] bool is_stated_fact(std::string_view member);

[[nodiscard]] StatedFacts stated_facts_from_json(ObjectReader& recording, Faults& faults);

/// Of a document that driftlab wrote: what cannot be read is left out.
[[nodiscard]] StatedFacts stated_facts_of(const Json& recording);

/// Adds the members that are stated.
void add_stated_facts(const StatedFacts& facts, Json& recording);

}  // namespace driftlab
