#include "schema/json/report_page.hpp"

#include "core/fit/characterise.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/figures.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"

namespace driftlab {
namespace {

std::string body_of(const Json& document) {
  if (is_characterisation(document)) {
    const std::string recordings = page::characterisation_html(document);
    return !document.contains("tables") ? recordings
                                        : recordings + page::parameter_tables_html({{"tables", document.at("tables")}});
  }
  if (document.contains("units") && document.contains("verdict")) {
    return page::regression_html(document);
  }
  if (document.contains("findings")) {
    return page::investigation_html(document);
  }
  if (document.contains("filters") && document.contains("claims")) {
    return page::outages_html(document);
  }
  if ((document.contains("columns") && document.contains("rows")) || document.contains("tables")) {
    return page::parameter_tables_html(document);
  }
  const Json summary = document.value("summary", Json(nullptr));
  return (summary.is_object() ? page::verdict_html(summary.value("verdict", "")) : "") + page::figures_html(document);
}

}  // namespace

Result<std::string> report_page(const Json& document, const std::string& device, const std::string& tables) {
  if (!document.is_object()) {
    return fail(ErrorCode::InvalidArgument, "The file holds no document of driftlab.");
  }
  try {
    const std::string body = body_of(document);
    if (body.empty()) {
      const auto figures = figures_of(document, "");
      return fail(figures ? Error{ErrorCode::InvalidArgument, "The document has nothing to report.", {}}
                          : figures.error());
    }
    const std::string title = device.empty() ? document.value("study", Json("")).is_string()
                                                   ? document.value("study", "driftlab report")
                                                   : "driftlab report"
                                             : device;
    const std::string printed = tables.empty() ? "" : "<h2>Parameters</h2>\n" + page::aligned_html(tables);
    return page::framed(title, body + printed + "<footer>driftlab " DRIFTLAB_VERSION ", algorithm " +
                                   std::to_string(kAlgorithmVersion) + "</footer>\n");
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Internal, std::string("The document is not as driftlab writes it: ") + error.what());
  }
}

}  // namespace driftlab
