#include "clients/cli/plot_file.hpp"

#include "schema/figure/drawing.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace driftlab::cli {
namespace {

Result<std::string> drawn(const figure::Figure& figure, const std::string& ending) {
  return ending == ".png" ? figure::to_png(figure) : Result<std::string>(figure::to_svg(figure));
}

Status write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    return fail(ErrorCode::Io, "The file " + path + " cannot be written.", {{"path", path}});
  }
  return {};
}

/// Why a figure cannot be written there; empty: it can.
std::string refusal_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const std::string ending = dot == std::string::npos ? "" : path.substr(dot);
  return path == "-" || ending == ".svg" || ending == ".png"
             ? ""
             : "Figures are written as .svg and .png, and - draws them in the terminal; '" + path + "' ends otherwise.";
}

}  // namespace

void add_plot_flag(CLI::App& command, std::string& path) {
  command.add_option("--plot", path, "Draw the result to this file (.svg, .png); - draws it in the terminal")
      ->check([](const std::string& given) { return refusal_of(given); });
}

Status write_plots(const Json& document, const std::string& path, const std::string& channel) {
  if (std::string refused = refusal_of(path); !refused.empty()) {
    return fail(ErrorCode::InvalidArgument, std::move(refused));
  }
  const std::size_t dot = path.rfind('.');
  const std::string ending = path == "-" ? "" : path.substr(dot);
  const auto figures = figures_of(document, channel);
  if (!figures) {
    return fail(figures.error());
  }
  for (const NamedFigure& one : *figures) {
    if (path == "-") {
      const std::string text = figure::to_terminal(one.figure) + "\n";
      std::fwrite(text.data(), 1, text.size(), stdout);
      continue;
    }
    const std::string name = figures->size() == 1 ? path : path.substr(0, dot) + "-" + one.name + ending;
    const auto bytes = drawn(one.figure, ending);
    if (!bytes) {
      return fail(bytes.error());
    }
    if (auto written = write_bytes(name, *bytes); !written) {
      return written;
    }
    if (figures->size() > 1) {
      std::fprintf(stderr, "driftlab: wrote %s\n", name.c_str());
    }
  }
  return {};
}

}  // namespace driftlab::cli
