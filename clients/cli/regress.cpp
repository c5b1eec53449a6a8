#include "clients/cli/regress_run.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {

void add_regress(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "regress", "Is the noise of this firmware no worse than before? Exit 0 pass, 1 fail, 3 undecided");
  const auto flags = std::make_shared<RegressFlags>();
  command->add_option("RUN", flags->run, "run.json; or name the recordings by --baseline and --candidate");
  add_regress_flags(*command, *flags);
  command->add_option("--out", flags->out, "Write document, summary, JUnit report, figure and badge into this folder");
  command->callback([flags, &chosen] { chosen = [flags] { return run_regress(*flags); }; });
}

}  // namespace driftlab::cli
