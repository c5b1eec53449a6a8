/// The report of an outage evaluation: verdict, figures, filters and what the paper claims.
#include "core/signal/with_count.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"
#include "schema/json/rounded.hpp"
#include "schema/json/stored_member.hpp"

#include <cstdint>

namespace driftlab::page {
namespace {

std::string whole_percent(double share) {
  return std::to_string(static_cast<int>(rounded(100.0 * share, 0).get<double>())) + " %";
}

}  // namespace

std::string outages_html(const Json& document) {
  const Json summary = document.value("summary", Json::object());
  std::string filters;
  for (const Json& filter : document.at("filters")) {
    const Json& error = filter.at("mean_error_m");
    filters += row_html({text_member(filter, "name"), std::to_string(filter.at("states").get<int>()),
                         with_interval(error.at("value").get<double>(), error.at("ci95")),
                         with_interval(filter.at("nees").get<double>(), filter.at("nees_ci95")),
                         whole_percent(filter.at("coverage95").get<double>())});
  }
  std::string claims;
  for (const Json& claim : document.at("claims")) {
    claims += row_html({text_member(claim, "claim"), claim.at("supported").get<bool>() ? "supported" : "not supported",
                        text_member(claim, "because")});
  }
  return verdict_html(text_member(summary, "verdict")) + list_html(summary.value("details", Json::array())) +
         figures_html(document) +
         table_html("Filters", {"filter", "states", "mean error [m]", "NEES", "in its 95 % ellipse"}, filters) +
         table_html("What the paper claims", {"claim", "", "because"}, claims) + "<p class=\"meta\">" +
         html(with_count(document.at("runs").get<int>(), "run") + ", seed " +
              std::to_string(document.at("seed").get<std::uint64_t>()) + ", algorithm " +
              std::to_string(document.at("algorithm_version").get<int>()) + ".") +
         "</p>\n";
}

}  // namespace driftlab::page
