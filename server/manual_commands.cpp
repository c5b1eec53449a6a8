#include "server/manual_commands.hpp"

#include "schema/shell/completion.hpp"
#include "schema/shell/manual.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace driftlab::server {
namespace {

/// The page of the manual, from the same source as --help.
std::string page_of(const CLI::App& app) {
  ManualFacts facts;
  facts.section = 8;
  facts.summary = "serve the characterisation of inertial sensors over HTTP";
  facts.version = DRIFTLAB_VERSION;
  facts.exit_codes = {{"0", "It was told to stop, and has stopped; of a command: success"},
                      {"1", "What was asked for could not be done, or something is damaged"},
                      {"2", "What was asked for cannot be; one sentence on standard error says why"},
                      {"3", "Of audit verify: the audit log is not whole"}};
  facts.files = {{"/etc/driftlab/driftlabd.env", "Variables of the service that systemd runs"},
                 {"/var/lib/driftlab", "Data of that service"}};
  facts.see_also = {"driftlab(1)"};
  return manual_page(command_tree(app, "driftlabd"), facts);
}

}  // namespace

ManualCommands::ManualCommands(CLI::App& app) : app_(app) {
  man_ = app.add_subcommand("man", "This manual as a man page, on standard output");
  CLI::App* const completion = app.add_subcommand("completion", "Completion for a shell, on standard output");
  completion->add_option("SHELL", shell_, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion_ = completion;
}

bool ManualCommands::parsed() const { return man_->parsed() || completion_->parsed(); }

int ManualCommands::run() const {
  if (man_->parsed()) {
    std::fputs(page_of(app_).c_str(), stdout);
    return 0;
  }
  const auto script = completion_script(command_tree(app_, "driftlabd"), shell_);
  std::fputs(script.value_or("").c_str(), stdout);
  return script ? 0 : 2;
}

}  // namespace driftlab::server
