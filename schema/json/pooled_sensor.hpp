#pragma once
/// One sensor axis of one device over all its recordings: replicates fitted jointly, their agreement, and whether one
/// structure serves every condition (core/fit/replicates.hpp, core/fit/structure.hpp).
///
/// Made from stored channel documents alone: their wavelet variances, sample counts and intervals are all that a joint
/// fit needs. A recording whose gross errors move the variances takes part with its robust variances, and the condition
/// is marked `robust`. Where a condition has one clean recording its own fits are taken over.
#include "core/signal/progress.hpp"
#include "schema/json/parameter_table.hpp"

#include <span>
#include <vector>

namespace driftlab {

/// {"quantity", "axis", "model", "structure", "conditions": [{"condition", "label", "recordings", "members",
/// "contamination", "robust", "agreement", "fits", "best"}]}. Conditions in table order; `model` is the common best.
/// `fits` of a condition are ordered by criterion; each says in `intervals` whether its intervals are `profile` (the
/// condition's best model and the common one) or `preview`. `previous`: other documents of the same axis;
/// conditions with the same members are taken from them. Errors: Cancelled; InvalidArgument (no sources; channels in
/// units of different dimension).
[[nodiscard]] Result<Json> pool_sensor(const std::vector<TableSource>& sources, std::span<const Json> previous,
                                       const RunControl& control);

/// The condition's entry of a pooled document if it was made of exactly these results; else nullptr. `members`: the
/// result ids (recording ids where there are none), in any order.
[[nodiscard]] const Json* find_pooled(const Json* pooled, const std::string& condition,
                                      std::vector<std::string> members);

/// The sources of one sensor axis.
struct SensorSources {
  std::string quantity;
  std::string axis;
  std::vector<TableSource> sources;
};
/// Of a characterisation document, in order of appearance; channels that nobody named by axis stand each for
/// themselves, under their column name.
[[nodiscard]] std::vector<SensorSources> sensors_of(const Json& characterisation);

/// Adds to a characterisation document of one device what its recordings say together: `replicates`, one pooled
/// document per sensor axis that has two recordings or more, and `trends` of their parameter tables by both methods
/// (schema/json/trend_table.hpp). Errors: Cancelled.
[[nodiscard]] Status add_summary(Json& characterisation, const std::string& device,
                                 const std::vector<SensorSources>& sensors, const RunControl& control);

/// The pooled document of a sensor axis in a characterisation document with a summary, or nullptr.
[[nodiscard]] const Json* pooled_of(const Json& characterisation, const SensorSources& sensor);

}  // namespace driftlab
