#pragma once
/// The figures of a document that driftlab wrote: what `driftlab plot`, `--plot` and `report` draw.
#include "schema/figure/plot.hpp"
#include "schema/json/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// A figure and the word that tells it from the others of its document: a channel, a parameter, a filter.
struct NamedFigure {
  std::string name;
  figure::Figure figure;
  std::string subject = {};  ///< by which it is asked for: its channel, axis or parameter; empty: by nothing
};

/// Whether a name is the one asked for, with its unit in brackets at the end or without: `gx (deg/s)` is `gx` too.
/// Nothing asked for is every name.
[[nodiscard]] bool is_asked_for(std::string_view name, std::string_view asked);

/// Of a characterisation (one a channel), an investigation (spectrum and wavelet deviation of each channel with a
/// series), a regression run (one a unit; `channel` is its axis, `z` or `gyro z`), an outage evaluation (errors by
/// outage), what was asked of a recorded drive (errors and a map for each duration) or a parameter table (one a
/// parameter). `channel`: of these alone; empty: all. Errors: InvalidArgument (a document of another kind; nothing of
/// that name, with those that there are); Internal (not as driftlab writes it).
[[nodiscard]] Result<std::vector<NamedFigure>> figures_of(const Json& document, const std::string& channel);

}  // namespace driftlab
