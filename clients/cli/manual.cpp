// `driftlab man` and `driftlab completion`: what the build installs beside the program.
#include "schema/shell/manual.hpp"

#include "clients/cli/cli.hpp"
#include "schema/shell/completion.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

Exit print_manual(const CLI::App& app) {
  ManualFacts facts;
  facts.summary = "characterise the stochastic errors of inertial sensors";
  facts.version = DRIFTLAB_VERSION;
  facts.exit_codes = {{"0", "Success; of a regression run: pass"},
                      {"1", "A finding of the command, such as a regression run that fails"},
                      {"2", "Input that cannot be; one sentence on standard error says what and how to repair it"},
                      {"3", "A regression run that decides nothing"},
                      {"4", "The daemon, or a job of it, failed"},
                      {"130", "Interrupted"}};
  facts.see_also = {"driftlabd(8)"};
  std::fputs(manual_page(command_tree(app, "driftlab"), facts).c_str(), stdout);
  return Exit::Success;
}

Exit print_completion(const CLI::App& app, const std::string& shell) {
  const auto script = completion_script(command_tree(app, "driftlab"), shell);
  std::fputs(script.value_or("").c_str(), stdout);
  return script ? Exit::Success : Exit::BadInput;
}

}  // namespace

void add_manual(CLI::App& app, Command& chosen) {
  CLI::App* const man = app.add_subcommand("man", "This manual as a man page, on standard output");
  man->callback([&app, &chosen] { chosen = [&app] { return print_manual(app); }; });
  CLI::App* const completion = app.add_subcommand("completion", "Completion for a shell, on standard output");
  const auto shell = std::make_shared<std::string>();
  completion->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([&app, &chosen, shell] { chosen = [&app, shell] { return print_completion(app, *shell); }; });
}

}  // namespace driftlab::cli
