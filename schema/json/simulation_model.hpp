#pragma once
/// A simulation model as a document: processes, deterministic part, effects (spec/results.md, `Model`).
///
///   {"processes": [{"process", "params": {name: {"value", "unit"}}}],      what every channel has, or the first one
///    "channels": {column: {"processes": [...]}},                           where channels differ
///    "deterministic": {column: {"bias": {...}, "drift": {...}}},        in units of the column's sensor
///    "effects": [{"cause", "channels", "recordings", "params"}],           what processes cannot hold
///    "unnamed": [...]}                                  profiles of what has no name (schema/json/unnamed_effect.hpp)
///
/// The same members make the `baseline` of a study, where `channels` may be a list of columns that narrows it.
#include "core/investigate/report/report.hpp"
#include "core/investigate/study/study.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Reads the members above and ignores the others. Faults are added at `pointer` and below.
[[nodiscard]] investigate::Baseline simulation_model_from_json(const Json& document, const std::string& pointer,
                                                               Faults& faults);

/// The `baseline` member of a study: {"kind": "auto"}, or {"kind": "model", ...} with the members of a model. Stored
/// models and fits (`id`) are faults here: a daemon puts them in place first (stored_baseline.hpp in server/jobs).
[[nodiscard]] investigate::Baseline baseline_from_json(const Json& document, const std::string& pointer,
                                                       Faults& faults);

/// The model that was criticised.
[[nodiscard]] Json baseline_json(const investigate::Report& report);
/// The same with the effects that were found, and with the base as it stands beside them.
[[nodiscard]] Json extended_json(const investigate::Report& report);

/// {"name": {"value", "unit", "ci95"}} of what was found.
[[nodiscard]] Json parameters_json(const investigate::Evidence& evidence);

}  // namespace driftlab
