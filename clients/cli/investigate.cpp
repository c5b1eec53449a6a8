#include "core/analysis/investigate.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/plot_file.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/study_request.hpp"
#include "schema/json/investigation.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <thread>

namespace driftlab::cli {
namespace {

struct InvestigateFlags {
  std::string study;
  std::string out;
  std::string markdown;
  bool json = false;
  std::string plot;
};

Exit run(const InvestigateFlags& flags) {
  auto inputs = read_inputs({flags.study}, {});
  if (!inputs) {
    return complain(inputs.error());
  }
  const auto request = investigation_request(*inputs);
  if (!request) {
    return complain(request.error());
  }
  auto recordings = LocalFiles::of(*inputs);
  if (!recordings) {
    return complain(recordings.error());
  }
  ProgressBar bar;
  Executor executor(std::thread::hardware_concurrency());
  const RunControl control{
      interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }, {&executor}};
  auto report = investigate_study(*request, **recordings, control);
  if (!report) {
    return complain_of_work(report.error());
  }
  const Json written = to_json(*report);
  if (!flags.plot.empty()) {
    if (auto drawn = write_plots(written, flags.plot); !drawn) {
      return complain(drawn.error());
    }
  }
  const std::string document = written.dump(2) + "\n";
  const std::string page = investigation_page(*report);
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
  const auto flags = std::make_shared<InvestigateFlags>();
  command->add_option("STUDY", flags->study, "study.json beside its recordings")->required();
  command->add_option("--out", flags->out, "Write the report document to this file");
  command->add_option("--markdown", flags->markdown, "Write the report as a Markdown page to this file");
  add_plot_flag(*command, flags->plot);
  command->add_flag("--json", flags->json, "Print the report document instead of the page");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
