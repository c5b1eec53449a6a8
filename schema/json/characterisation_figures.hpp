#pragma once
/// The figures of a characterisation: the Allan deviation of each channel with its best model.
#include "core/analysis/stored_channel.hpp"
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// The Allan deviation of a channel with its best model: points with intervals, robust estimate, model and components,
/// and measured over model below; what the pages draw. Precondition: the channel has an Allan deviation.
[[nodiscard]] figure::Figure allan_figure(const StoredChannel& channel, const std::string& recording);

/// One for each channel of the document that has a curve. `channel`: of this alone; empty: of all. Throws
/// Json::exception where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_characterisation(const Json& document, const std::string& channel);

}  // namespace driftlab
