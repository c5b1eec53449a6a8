#include "schema/shell/command_tree.hpp"

#include <CLI/CLI.hpp>

namespace driftlab {
namespace {

/// `TEXT:{text,csv}` is a TEXT out of two.
void read_type(const std::string& type, ProgramOption& option) {
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  const std::size_t open = type.find('{');
  const std::size_t close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos || close < open) {
    return;
  }
  std::string word;
  for (const char c : type.substr(open + 1, close - open - 1) + ",") {
    if (c != ',') {
      word += c;
    } else if (!word.empty()) {
      option.choices.push_back(std::move(word));
      word.clear();
    }
  }
}

ProgramOption read_option(const CLI::Option& option) {
  ProgramOption found;
  for (const std::string& name : option.get_snames()) {
    found.flags.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    found.flags.push_back("--" + name);
  }
  if (option.get_items_expected_max() > 0) {
    read_type(option.get_type_name(), found);
  }
  if (found.flags.empty()) {
    found.value = option.get_name(true);
  }
  found.default_value = option.get_default_str();
  found.variable = option.get_envname();
  found.meaning = option.get_description();
  found.required = option.get_required();
  return found;
}

}  // namespace

ProgramCommand command_tree(const CLI::App& app, const std::string& program) {
  ProgramCommand found{program, app.get_description(), {}, {}};
  for (const CLI::Option* const option : app.get_options()) {
    found.options.push_back(read_option(*option));
  }
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    found.commands.push_back(command_tree(*command, program + " " + command->get_name()));
  }
  return found;
}

}  // namespace driftlab
