#pragma once
/// Figures of documents, written where `--plot` says.
#include "clients/cli/cli.hpp"
#include "schema/json/figures.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own
class App;
}

namespace driftlab::cli {

/// Adds `--plot`, the same for every command.
void add_plot_flag(CLI::App& command, std::string& path);

/// Writes the figures of a document: to `path` by its ending (.svg, .png), each to a file of its own where there are
/// several (`plot-gx.svg`), or in characters to standard output where `path` is `-`. Errors: InvalidArgument (another
/// ending; nothing to draw), Io.
[[nodiscard]] Status write_plots(const Json& document, const std::string& path, const std::string& channel = "");

}  // namespace driftlab::cli
