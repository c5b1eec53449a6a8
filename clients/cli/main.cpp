// driftlab: the command line. See `driftlab --help` and schema/docs/cli.md.
#include "clients/cli/cli.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace driftlab::cli {

Exit complain(const Error& error, Exit exit) {
  std::string text = "driftlab: " + error.message;
  std::string where;
  for (const ErrorField& field : error.fields) {
    if (field.name.size() > 1 && field.name.starts_with('/') && where.empty()) {
      where = "at " + field.name;  // the first of a document's faults is the one in the sentence
    }
    // Other pointers, paths and the names already in the sentence say nothing new to a person.
    if (!field.name.starts_with('/') && field.name != "path" && error.message.find(field.value) == std::string::npos) {
      where += (where.empty() ? "" : ", ") + field.name + " " + field.value;
    }
  }
  if (!where.empty()) {
    text += " (" + where + ")";
  }
  std::fprintf(stderr, "%s\n", text.c_str());
  return exit;
}

Exit complain(const Error& error) { return complain(error, Exit::BadInput); }

Exit complain_of_work(const Error& error) {
  return complain(error, error.code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput);
}

}  // namespace driftlab::cli

int main(int argc, char** argv) {
  using driftlab::cli::Exit;
  CLI::App app{"driftlab characterises the stochastic errors of inertial sensors."};
  app.set_version_flag("--version", std::string("driftlab " DRIFTLAB_VERSION));
  app.require_subcommand(1);
  driftlab::cli::Command chosen;
  driftlab::cli::add_all_commands(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      return app.exit(error);
    }
    std::fprintf(stderr, "driftlab: %s (--help lists the options)\n", error.what());
    return static_cast<int>(Exit::BadInput);
  }
  driftlab::cli::watch_interrupts();
  return static_cast<int>(chosen());
}
