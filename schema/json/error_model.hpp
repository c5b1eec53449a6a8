#pragma once
/// Error models as documents (spec/study.md, spec/results.md): lists of
/// {"process": "gauss_markov", "params": {"sigma": {"value": 62, "unit": "deg/h"}, "beta": {"value": 1.7, "unit":
/// "1/s"}}}. The `processes` of a stored fit are read as they are: the interval of a parameter and the `reasons` of a
/// process are let be, and a parameter that was not identified is a fault.
#include "core/process/model.hpp"
#include "core/signal/unit.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <string>

namespace driftlab {

/// Faults are added at `pointer` and below. `channel` is the dimension of the channel that the model describes; where
/// it is not known the unit of the first level tells it, and it is set.
[[nodiscard]] Model model_from_json(const Json& processes, std::optional<Dimension>& channel,
                                    const std::string& pointer, Faults& faults);

/// The same for a known channel, where a number alone, without value and unit, is SI. At most kMaxModelProcesses.
[[nodiscard]] Model model_from_json(const Json& processes, Dimension channel, const std::string& pointer,
                                    Faults& faults);

/// In the units engineers use.
[[nodiscard]] Json to_json(const Model& model, Dimension channel);

/// Numbers alone, in SI, to the last bit.
[[nodiscard]] Json to_si_json(const Model& model);

}  // namespace driftlab
