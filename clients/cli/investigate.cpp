#include "core/investigate/investigate.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/workspace.hpp"
#include "core/investigate/report/explain.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "schema/json/investigation.hpp"
#include "schema/json/simulation_model.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <deque>
#include <fstream>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

struct Flags {
  std::string study;
  std::string out;
  std::string markdown;
  bool json = false;
};

/// The study with its decoded columns, which the recordings point into.
struct LoadedStudy {
  investigate::Study study;
  std::deque<ColumnFile> columns;
};

Result<LoadedStudy> load(const Inputs& inputs, const RunControl& control) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  LoadedStudy loaded;
  loaded.study.id = inputs.study.is_string() ? inputs.study.get<std::string>() : inputs.device;
  loaded.study.device = inputs.device;
  if (!inputs.baseline.is_null()) {
    Faults faults;
    loaded.study.baseline = baseline_from_json(inputs.baseline, "/baseline", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
  }
  for (const InputFile& file : inputs.files) {
    const auto at_file = [&](Error error) {
      error.message = file.path.string() + ": " + error.message;
      return fail(std::move(error));
    };
    auto decoded = decode_file(file.path, workspace->file(), {}, control);
    if (!decoded) {
      return at_file(decoded.error());
    }
    auto columns = ColumnFile::open(workspace->file());
    if (!columns) {
      return at_file(columns.error());
    }
    loaded.columns.push_back(std::move(*columns));
    const ColumnFile& table = loaded.columns.back();
    auto recording = investigate::make_study_recording(file.spec, table.names(), table.rows(),
                                                       [&](std::size_t i) { return table.column(i); });
    if (!recording) {
      return at_file(recording.error());
    }
    for (const std::string& note : recording->notes) {
      loaded.study.notes.push_back(file.spec.id + ": " + note);
    }
    loaded.study.recordings.push_back(std::move(*recording));
  }
  investigate::settle_channels(loaded.study);
  return loaded;
}

bool write_file(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  return static_cast<bool>(out);
}

Exit run(const Flags& flags) {
  auto inputs = read_inputs({flags.study}, {});
  if (!inputs) {
    return complain(inputs.error());
  }
  ProgressBar bar;
  Executor executor(std::thread::hardware_concurrency());
  const RunControl control{
      interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }, {&executor}};
  auto loaded = load(*inputs, control);
  if (!loaded) {
    const bool stopped = loaded.error().code == ErrorCode::Cancelled;
    return stopped ? complain(loaded.error(), Exit::Interrupted) : complain(loaded.error());
  }
  auto report = investigate::investigate(loaded->study, {}, control);
  if (!report) {
    const bool stopped = report.error().code == ErrorCode::Cancelled;
    return stopped ? complain(report.error(), Exit::Interrupted) : complain(report.error());
  }
  const std::string document = to_json(*report).dump(2) + "\n";
  const std::string page = investigate::markdown(*report);
  for (const auto& [path, text] : {std::pair{flags.out, &document}, std::pair{flags.markdown, &page}}) {
    if (!path.empty() && !write_file(path, *text)) {
      return complain({ErrorCode::Io, "The file " + path + " cannot be written.", {}});
    }
  }
  if (flags.json || (flags.out.empty() && flags.markdown.empty())) {
    const std::string& text = flags.json ? document : page;
    std::fwrite(text.data(), 1, text.size(), stdout);
  }
  return Exit::Success;
}

}  // namespace

void add_investigate(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("investigate", "Say what a simulation gets wrong about a study's recordings, and why");
  const auto flags = std::make_shared<Flags>();
  command->add_option("STUDY", flags->study, "study.json beside its recordings")->required();
  command->add_option("--out", flags->out, "Write the report document to this file");
  command->add_option("--markdown", flags->markdown, "Write the report as a Markdown page to this file");
  command->add_flag("--json", flags->json, "Print the report document instead of the page");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
