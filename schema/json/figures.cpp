#include "schema/json/figures.hpp"

#include "schema/json/characterisation_figures.hpp"
#include "schema/json/drive_figures.hpp"
#include "schema/json/investigation_figures.hpp"
#include "schema/json/outage_figures.hpp"
#include "schema/json/regression_figures.hpp"
#include "schema/json/table_figures.hpp"

namespace driftlab {

Result<std::vector<NamedFigure>> figures_of(const Json& document, const std::string& channel) {
  try {
    std::vector<NamedFigure> figures;
    if (document.contains("recordings") && document["recordings"].is_array()) {
      figures = figures_of_characterisation(document, channel);
    } else if (document.contains("units") && document.contains("verdict")) {
      figures = figures_of_regression(document, channel);
    } else if (is_drive_evaluation(document)) {
      figures = figures_of_drive(document);
    } else if (document.contains("findings")) {
      figures = figures_of_investigation(document, channel);
    } else if (document.contains("filters") && document.contains("runs")) {
      figures = figures_of_outages(document);
    } else if (document.contains("columns") && document.contains("rows")) {
      figures = figures_of_table(document, channel);
    } else if (document.contains("tables") && document["tables"].is_array()) {
      figures = figures_of_tables(document, channel);
    } else {
      return fail(
          ErrorCode::InvalidArgument,
          "This is no document with a figure: a characterisation, an investigation, an outage evaluation, what a "
          "recorded drive answers, a regression run, a parameter table or those of all axes, as --json writes them.");
    }
    if (figures.empty()) {
      return fail(ErrorCode::InvalidArgument, channel.empty()
                                                  ? "The document has nothing to draw: no curve with a point."
                                                  : "The document has no figure of '" + channel + "'.");
    }
    return figures;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Internal, std::string("The document is not as driftlab writes it: ") + error.what());
  }
}

}  // namespace driftlab
