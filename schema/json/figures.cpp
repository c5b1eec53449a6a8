#include "schema/json/figures.hpp"

#include "core/signal/name_list.hpp"
#include "core/signal/text.hpp"
#include "schema/json/characterisation_figures.hpp"
#include "schema/json/drive_figures.hpp"
#include "schema/json/investigation_figures.hpp"
#include "schema/json/outage_figures.hpp"
#include "schema/json/regression_figures.hpp"
#include "schema/json/table_figures.hpp"

#include <set>

namespace driftlab {
namespace {

constexpr std::size_t kMostNames = 12;

/// Why a document has no figure of a channel, with those that it has.
std::string no_figure_of(const Json& document, const std::string& channel) {
  const std::string sentence = "The document has no figure of '" + channel + "'";
  const auto all = figures_of(document, "");
  if (!all) {
    return sentence + ".";
  }
  NameList names(kMostNames);
  std::set<std::string> seen;
  for (const NamedFigure& one : *all) {
    if (!one.subject.empty() && seen.insert(one.subject).second) {
      names.add(one.subject);
    }
  }
  return sentence + (names.empty() ? "." : "; it has figures of " + names.text() + ".");
}

}  // namespace

bool is_asked_for(std::string_view name, std::string_view asked) {
  if (asked.empty() || name == asked) {
    return true;
  }
  const bool has_unit = name.ends_with(')') || name.ends_with(']');
  const std::size_t unit = has_unit ? name.rfind(name.back() == ')' ? '(' : '[') : std::string_view::npos;
  return unit != std::string_view::npos && unit > 0 && trimmed(name.substr(0, unit)) == asked;
}

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
                                                  : no_figure_of(document, channel));
    }
    return figures;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Internal, std::string("The document is not as driftlab writes it: ") + error.what());
  }
}

}  // namespace driftlab
