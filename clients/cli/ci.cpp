#include "clients/cli/regress_run.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {

/// `regress` as a pipeline wants it: everything in one folder, nothing asked, the verdict in the exit code.
void add_ci(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("ci", "The regression run of a pipeline: all artefacts in one folder, verdict as exit code");
  const auto flags = std::make_shared<RegressFlags>();
  flags->out = "driftlab-report";
  command->add_option("RUN", flags->run, "run.json; or name the recordings by --baseline and --candidate");
  add_regress_flags(*command, *flags);
  command->add_option("--out", flags->out, "Folder of the artefacts")->capture_default_str();
  command->callback([flags, &chosen] { chosen = [flags] { return run_regress(*flags); }; });
}

}  // namespace driftlab::cli
