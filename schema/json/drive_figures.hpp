#pragma once
/// The figures of what was asked of a recorded drive: how errors grow in its outages, and a map of them.
#include "schema/json/figures.hpp"

#include <vector>

namespace driftlab {

/// True for a document of schema/drive-evaluation.schema.json.
[[nodiscard]] bool is_drive_evaluation(const Json& document);

/// One pair for each duration: the error against the time in an outage, measured over the simulated band where there is
/// a simulation, and the map, with the drive's way, where outages ended, the error of each as a line to where the
/// filter believed to be, and the 95 % ellipse about it, coloured by NEES. Of an explanation: before and after mending;
/// the map is of the mended model. Of a comparison: one error figure with every filter. Throws Json::exception where
/// the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_drive(const Json& document);

}  // namespace driftlab
