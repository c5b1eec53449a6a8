#include "schema/shell/manual.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>

namespace driftlab {
namespace {

/// Text that troff sets as it is: no escape, no request at the beginning of a line, hyphens that can be copied.
std::string plain(const std::string& text) {
  std::string set;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) {
      set += "\\&";
    }
    if (c == '\\') {
      set += "\\e";
    } else if (c == '-') {
      set += "\\-";
    } else if (c == '`') {
      set += "\\(ga";
    } else {
      set += c;
    }
    begins = c == '\n';
  }
  return set;
}

/// The page with every character beyond ASCII as \[uXXXX], which troff takes whatever encoding it is told.
std::string in_ascii(const std::string& page) {
  std::string set;
  for (std::size_t i = 0; i < page.size();) {
    const auto first = static_cast<unsigned char>(page[i]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (length == 1) {
      set += page[i++];
      continue;
    }
    unsigned code = first & (0x7FU >> length);
    for (std::size_t k = 1; k < length && i + k < page.size(); ++k) {
      code = code << 6U | (static_cast<unsigned char>(page[i + k]) & 0x3FU);
    }
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "\\[u%04X]", code);
    set += text.data();
    i += length;
  }
  return set;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.' && text.back() != ':') {
    text += '.';
  }
  return text;
}

void write_option(std::string& page, const ProgramOption& option) {
  page += ".TP\n";
  if (option.flags.empty()) {
    page += italic(option.value);
  }
  for (std::size_t i = 0; i < option.flags.size(); ++i) {
    page += (i == 0 ? "" : ", ") + bold(option.flags[i]);
  }
  if (!option.flags.empty() && !option.value.empty()) {
    page += " " + italic(option.value);
  }
  page += "\n" + plain(sentence(option.meaning));
  if (!option.choices.empty()) {
    std::string known;
    for (const std::string& choice : option.choices) {
      known += (known.empty() ? "" : ", ") + choice;
    }
    page += "\nOne of " + plain(known) + ".";
  }
  if (option.required) {
    page += "\nRequired.";
  } else if (!option.default_value.empty()) {
    page += "\nDefault: " + plain(option.default_value) + ".";
  }
  if (!option.variable.empty()) {
    page += "\nVariable: " + bold(option.variable) + ".";
  }
  page += "\n";
}

void write_options(std::string& page, const ProgramCommand& command) {
  for (const ProgramOption& option : command.options) {
    const bool known = std::find(option.flags.begin(), option.flags.end(), "--help") != option.flags.end();
    if (!known || command.path.find(' ') == std::string::npos) {
      write_option(page, option);
    }
  }
}

void write_commands(std::string& page, const ProgramCommand& parent) {
  for (const ProgramCommand& command : parent.commands) {
    page += ".SS " + bold(command.path) + "\n" + plain(sentence(command.meaning)) + "\n";
    write_options(page, command);
    write_commands(page, command);
  }
}

void collect_variables(const ProgramCommand& command, std::map<std::string, std::string>& found) {
  for (const ProgramOption& option : command.options) {
    if (!option.variable.empty() && !option.flags.empty()) {
      found.emplace(option.variable, option.flags.back());
    }
  }
  for (const ProgramCommand& child : command.commands) {
    collect_variables(child, found);
  }
}

void write_pairs(std::string& page, const char* title, const std::vector<std::pair<std::string, std::string>>& pairs) {
  if (pairs.empty()) {
    return;
  }
  page += std::string(".SH ") + title + "\n";
  for (const auto& [name, meaning] : pairs) {
    page += ".TP\n" + bold(name) + "\n" + plain(sentence(meaning)) + "\n";
  }
}

}  // namespace

std::string manual_page(const ProgramCommand& program, const ManualFacts& facts) {
  std::string upper = program.path;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string page = ".TH " + upper + " " + std::to_string(facts.section) + " \"\" \"driftlab " + facts.version +
                     "\" \"driftlab\"\n.nh\n.ad l\n.SH NAME\n" + plain(program.path) + " \\- " + plain(facts.summary) +
                     "\n";
  page += ".SH SYNOPSIS\n" + bold(program.path) + " [" + italic("options") + "] " + italic("command") + " [" +
          italic("options") + "]\n";
  page += ".SH DESCRIPTION\n" + plain(program.meaning) + "\n.SH OPTIONS\n";
  write_options(page, program);
  page += ".SH COMMANDS\n";
  write_commands(page, program);
  write_pairs(page, "EXIT STATUS", facts.exit_codes);
  std::map<std::string, std::string> variables;
  collect_variables(program, variables);
  std::vector<std::pair<std::string, std::string>> told;
  for (const auto& [variable, flag] : variables) {
    told.emplace_back(variable, "What " + flag + " says where it is not given");
  }
  write_pairs(page, "ENVIRONMENT", told);
  write_pairs(page, "FILES", facts.files);
  if (!facts.see_also.empty()) {
    std::string others;
    for (const std::string& other : facts.see_also) {
      others += (others.empty() ? "" : ", ") + plain(other);
    }
    page += ".SH SEE ALSO\n" + others + "\n";
  }
  return in_ascii(page);
}

}  // namespace driftlab
