#include "schema/shell/completion.hpp"

namespace driftlab {
namespace {

/// Every command of the tree, parents first.
void flatten(const ProgramCommand& command, std::vector<const ProgramCommand*>& all) {
  all.push_back(&command);
  for (const ProgramCommand& child : command.commands) {
    flatten(child, all);
  }
}

std::string last_word(const std::string& path) { return path.substr(path.rfind(' ') + 1); }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

/// In single quotes; one inside is closed, escaped and opened again.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

/// The options of the program itself may stand behind every command.
std::vector<ProgramOption> options_at(const ProgramCommand& program, const ProgramCommand& command) {
  std::vector<ProgramOption> options = command.options;
  if (&program != &command) {
    for (const ProgramOption& option : program.options) {
      const bool own = option.flags.empty() || option.flags.back() == "--help" || option.flags.back() == "--version";
      if (!own) {
        options.push_back(option);
      }
    }
  }
  return options;
}

/// The branches that find how far down the words before the cursor lead, in the syntax that bash and zsh share.
std::string descent(const std::vector<const ProgramCommand*>& all) {
  std::string text;
  for (std::size_t i = 1; i < all.size(); ++i) {
    text += "      " + quoted(all[i]->path) + ") at=" + quoted(all[i]->path) + " ;;\n";
  }
  return text;
}

std::string function_name(const ProgramCommand& program) { return "_" + program.path; }

std::string bash_script(const ProgramCommand& program) {
  std::vector<const ProgramCommand*> all;
  flatten(program, all);
  std::string values;
  std::string offers;
  for (const ProgramCommand* const command : all) {
    std::vector<std::string> flags;
    std::vector<std::string> commands;
    for (const ProgramOption& option : options_at(program, *command)) {
      flags.insert(flags.end(), option.flags.begin(), option.flags.end());
      for (const std::string& flag : option.flags) {
        if (!option.value.empty()) {
          values += "    " + quoted(command->path + " " + flag) + ") words=" + quoted(joined(option.choices)) +
                    "; takes=1 ;;\n";
        }
      }
    }
    for (const ProgramCommand& child : command->commands) {
      commands.push_back(last_word(child.path));
    }
    offers += "    " + quoted(command->path) + ") flags=" + quoted(joined(flags)) +
              "; commands=" + quoted(joined(commands)) + " ;;\n";
  }
  return "# bash completion of " + program.path + ", written by `" + program.path + " completion bash`\n" +
         function_name(program) + "() {\n" +
         "  local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} at=" + quoted(program.path) +
         "\n  local words='' flags='' commands='' takes='' i\n"
         "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case \"$at ${COMP_WORDS[i]}\" in\n" +
         descent(all) + "    esac\n  done\n  case \"$at $before\" in\n" + values + "  esac\n  case \"$at\" in\n" +
         offers +
         "  esac\n"
         "  if [ -z \"$takes\" ]; then\n"
         "    case \"$cur\" in\n      -*) words=$flags ;;\n      *) words=$commands ;;\n    esac\n  fi\n"
         "  COMPREPLY=()\n"
         "  [ -z \"$words\" ] || while IFS='' read -r i; do COMPREPLY+=(\"$i\"); done < <(compgen -W \"$words\" -- "
         "\"$cur\")\n"
         "}\n"
         "complete -o default -F " +
         function_name(program) + " " + program.path + "\n";
}

/// `word:meaning` of _describe, where a colon belongs to neither.
std::string described(const std::string& word, const std::string& meaning) {
  std::string text = word + ":";
  for (const char c : meaning) {
    text += c == ':' ? std::string("\\:") : c == '\n' ? std::string(" ") : std::string(1, c);
  }
  return quoted(text);
}

std::string zsh_script(const ProgramCommand& program) {
  std::vector<const ProgramCommand*> all;
  flatten(program, all);
  std::string values;
  std::string offers;
  for (const ProgramCommand* const command : all) {
    std::string flags;
    std::string commands;
    for (const ProgramOption& option : options_at(program, *command)) {
      for (const std::string& flag : option.flags) {
        flags += " " + described(flag, option.meaning);
        if (!option.value.empty()) {
          std::string typed = command->path;
          typed.append(" ").append(flag);
          values.append("    ").append(quoted(typed)).append(") ");
          values.append(option.choices.empty() ? "_files" : "compadd -- " + joined(option.choices));
          values.append("; return ;;\n");
        }
      }
    }
    for (const ProgramCommand& child : command->commands) {
      commands += " " + described(last_word(child.path), child.meaning);
    }
    offers.append("    ").append(quoted(command->path)).append(") flags=(").append(flags);
    offers.append(" ); commands=(").append(commands).append(" ) ;;\n");
  }
  return "#compdef " + program.path + "\n# zsh completion of " + program.path + ", written by `" + program.path +
         " completion zsh`\n" + function_name(program) + "() {\n  local at=" + quoted(program.path) +
         " word\n  local -a flags commands\n"
         "  for word in \"${(@)words[2,CURRENT-1]}\"; do\n    case \"$at $word\" in\n" +
         descent(all) + "    esac\n  done\n  case \"$at ${words[CURRENT-1]}\" in\n" + values +
         "  esac\n  case \"$at\" in\n" + offers +
         "  esac\n"
         "  if [[ \"${words[CURRENT]}\" == -* ]]; then\n    _describe -o 'option' flags\n"
         "  elif (( ${#commands} )); then\n    _describe 'command' commands\n  else\n    _files\n  fi\n}\n" +
         "if [ \"${funcstack[1]}\" = " + quoted(function_name(program)) + " ]; then\n  " + function_name(program) +
         " \"$@\"\nelse\n  compdef " + function_name(program) + " " + program.path + "\nfi\n";
}

std::string fish_script(const ProgramCommand& program) {
  std::vector<const ProgramCommand*> all;
  flatten(program, all);
  const std::string where = "__" + program.path + "_at";
  std::string text = "# fish completion of " + program.path + ", written by `" + program.path + " completion fish`\n" +
                     "function " + where + "\n  set -l at " + quoted(program.path) +
                     "\n  for word in (commandline -opc)[2..-1]\n    switch \"$at $word\"\n";
  for (std::size_t i = 1; i < all.size(); ++i) {
    text += "      case " + quoted(all[i]->path) + "\n        set at " + quoted(all[i]->path) + "\n";
  }
  text += "    end\n  end\n  test \"$at\" = \"$argv[1]\"\nend\n";
  for (const ProgramCommand* const command : all) {
    const std::string begin =
        "complete -c " + program.path + " -n " + quoted(where + " \"" + command->path + "\"") + " ";
    for (const ProgramCommand& child : command->commands) {
      text += begin + "-f -a " + quoted(last_word(child.path)) + " -d " + quoted(child.meaning) + "\n";
    }
    for (const ProgramOption& option : options_at(program, *command)) {
      if (option.flags.empty()) {
        continue;
      }
      text += begin;
      for (const std::string& flag : option.flags) {
        text += flag.starts_with("--") ? "-l " + flag.substr(2) + " " : "-s " + flag.substr(1) + " ";
      }
      text += option.value.empty()     ? ""
              : option.choices.empty() ? "-r -F "
                                       : "-x -a " + quoted(joined(option.choices)) + " ";
      text += "-d " + quoted(option.meaning) + "\n";
    }
  }
  return text;
}

}  // namespace

std::optional<std::string> completion_script(const ProgramCommand& program, std::string_view shell) {
  if (shell == "bash") {
    return bash_script(program);
  }
  if (shell == "zsh") {
    return zsh_script(program);
  }
  return shell == "fish" ? std::optional(fish_script(program)) : std::nullopt;
}

}  // namespace driftlab
