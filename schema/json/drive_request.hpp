#pragma once
/// The request of a drive evaluation as JSON: the parameters of a job of kind `drive_evaluation`.
#include "core/analysis/drive.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Every member, those that the question does not take left out.
[[nodiscard]] Json to_json(const DriveRequest& request);

/// Members that are missing have their defaults; one that the question does not take is a fault.
[[nodiscard]] DriveRequest drive_request_from_json(const Json& document, const std::string& pointer, Faults& faults);

/// The document that answers, as the command line prints it.
[[nodiscard]] Json to_json(const DriveAnswer& answer);

}  // namespace driftlab
