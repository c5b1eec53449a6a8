#pragma once
/// A program's commands and options as --help tells of them, in a form that manuals and completions are written from.
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own
class App;
}

namespace driftlab {

struct ProgramOption {
  std::vector<std::string> flags;  ///< `-h`, `--help`; empty: a positional
  std::string value;               ///< what it takes: `TEXT`, or the name of a positional; empty: nothing
  std::vector<std::string> choices;
  std::string default_value;
  std::string variable;  ///< of the environment
  std::string meaning;
  bool required = false;
};

struct ProgramCommand {
  std::string path;  ///< `driftlab drive run`
  std::string meaning;
  std::vector<ProgramOption> options;
  std::vector<ProgramCommand> commands;
};

/// The whole tree under `app`, whose name on the command line is `program`.
[[nodiscard]] ProgramCommand command_tree(const CLI::App& app, const std::string& program);

}  // namespace driftlab
