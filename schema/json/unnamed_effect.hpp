#pragma once
/// A profile without a name as a document, in a model and in the report that found it:
///
///   {"kind": "spectrum" | "variance" | "mean", "against": "frequency" | "time" | "rate" | "angular_acceleration" |
///    "temperature" | "angle", "along": unit, "channel", "recordings"?, "edges": n + 1 numbers, "values": n numbers,
///    "unit": of a mean}
///
/// Edges are in the unit `along`: Hz, s, deg/s, deg/s^2, degC or deg. Values of a spectrum or variance are ratios.
#include "core/investigate/unnamed/unnamed_search.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Adds the profile to the model. Faults are added at `pointer` and below.
void read_unnamed_effect(const Json& document, const std::string& pointer, investigate::Baseline& model,
                         Faults& faults);

[[nodiscard]] Json to_json(const investigate::UnnamedEffect& effect, const Unit& channel);

/// The same with the middles of the bins, 95 % intervals, the gain on data that it was not fitted to, and a sentence.
[[nodiscard]] Json to_json(const investigate::UnnamedFinding& found, const Unit& channel);

/// The change of a stored model, as change_json of a finding (schema/json/investigation.hpp).
[[nodiscard]] Json change_json(const investigate::UnnamedFinding& found);

}  // namespace driftlab
