#pragma once
/// What stands between the title and the foot of a report: one function for each kind of document, each in its file.
/// All of them throw Json::exception where the document is not as driftlab writes it. Internal to schema/json.
#include "schema/json/json.hpp"

#include <string>

namespace driftlab::page {

[[nodiscard]] std::string characterisation_html(const Json& document);
[[nodiscard]] std::string investigation_html(const Json& document);
[[nodiscard]] std::string regression_html(const Json& document);
[[nodiscard]] std::string outages_html(const Json& document);
/// Of one parameter table, or of those of all axes of a sensor.
[[nodiscard]] std::string parameter_tables_html(const Json& document);

}  // namespace driftlab::page
