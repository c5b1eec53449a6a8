#pragma once
/// Error models as documents (spec/study.md, spec/results.md): lists of
/// {"process": "gauss_markov", "params": {"sigma": {"value": 62, "unit": "deg/h"}, "beta": {"value": 1.7, "unit":
/// "1/s"}}}. The `processes` of a stored fit are read as they are; intervals and other members of a parameter are
/// ignored.
#include "core/process/model.hpp"
#include "core/signal/unit.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Faults are added at `pointer` and below. A number alone, without value and unit, is SI.
[[nodiscard]] Model model_from_json(const Json& processes, Dimension channel, const std::string& pointer,
                                    Faults& faults);

/// In the units engineers use.
[[nodiscard]] Json to_json(const Model& model, Dimension channel);

}  // namespace driftlab
