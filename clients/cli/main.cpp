// driftlab: the command line. See `driftlab --help` and schema/docs/cli.md.
#include "clients/cli/cli.hpp"
#include "clients/cli/http_client.hpp"
#include "core/signal/text.hpp"

#include <CLI/CLI.hpp>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string_view>

namespace driftlab::cli {

namespace {

/// The sentence with the rate called as the command line calls it, where it is what is wrong.
std::string with_flags(const Error& error) {
  constexpr std::string_view kName = "rate_hz";
  std::string text = error.message;
  const bool is_rate = std::any_of(error.fields.begin(), error.fields.end(), [&](const ErrorField& field) {
    return field.name == "parameter" && field.value == kName;
  });
  if (const std::size_t at = text.find(kName); is_rate && at != std::string::npos) {
    text.replace(at, kName.size(), "--rate-hz (rate_hz in a study)");
  }
  return text;
}

}  // namespace

std::string sentence_of(const Error& error) {
  std::string text = with_flags(error);
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
  return text;
}

Exit complain(const Error& error, Exit exit) {
  std::fprintf(stderr, "driftlab: %s\n", sentence_of(error).c_str());
  return exit;
}

Exit complain(const Error& error) { return complain(error, Exit::BadInput); }

Exit complain_of_work(const Error& error) {
  return complain(error, error.code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput);
}

namespace {

/// The first word is no command: which there are. Empty where it is one, or there is no word.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    return "";
  }
  std::string names;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->check_name(argv[1])) {
      return "";
    }
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return "There is no command '" + std::string(argv[1]) + "'; there are " + names + ".";
}

/// What stands in the file, or in DRIFTLAB_TOKEN; white space around it does not belong to it. Error: NotFound.
Result<std::string> read_token(const std::string& path) {
  if (path.empty()) {
    const char* const variable = std::getenv("DRIFTLAB_TOKEN");  // NOLINT(concurrency-mt-unsafe): before any thread
    return std::string(trimmed(variable != nullptr ? variable : ""));
  }
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line) || trimmed(line).empty()) {
    return fail(ErrorCode::NotFound, "The file " + path + " holds no token, or cannot be opened.");
  }
  return std::string(trimmed(line));
}

}  // namespace

}  // namespace driftlab::cli

namespace {

/// Whole columns are made and dropped all the time, and the process ends soon: memory that was given back would be
/// asked for again, page by page.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMebi = 1 << 20;
  (void)::mallopt(M_MMAP_THRESHOLD, 64 * kMebi);   // NOLINT(concurrency-mt-unsafe): no other thread yet
  (void)::mallopt(M_TRIM_THRESHOLD, 256 * kMebi);  // NOLINT(concurrency-mt-unsafe)
#endif
}

}  // namespace

int main(int argc, char** argv) {
  using driftlab::cli::Exit;
  keep_freed_memory();
  CLI::App app{"driftlab characterises the stochastic errors of inertial sensors."};
  app.set_version_flag("--version", std::string("driftlab " DRIFTLAB_VERSION));
  app.require_subcommand(1);
  app.fallthrough();  // the option may stand behind the command
  std::string token_file;
  app.add_option("--token-file", token_file, "File with the token of a daemon that asks for one; else DRIFTLAB_TOKEN")
      ->envname("DRIFTLAB_TOKEN_FILE");
  std::string ca_file;
  app.add_option("--ca-file", ca_file, "PEM file of the authorities to trust for https; else those of the system")
      ->envname("DRIFTLAB_CA_FILE");
  driftlab::cli::Command chosen;
  driftlab::cli::add_all_commands(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      return app.exit(error);
    }
    if (const std::string unknown = driftlab::cli::unknown_command(app, argc, argv); !unknown.empty()) {
      return static_cast<int>(driftlab::cli::complain({driftlab::ErrorCode::InvalidArgument, unknown, {}}));
    }
    std::fprintf(stderr, "driftlab: %s (--help lists the options)\n", error.what());
    return static_cast<int>(Exit::BadInput);
  }
  auto token = driftlab::cli::read_token(token_file);
  if (!token) {
    return static_cast<int>(driftlab::cli::complain(token.error()));
  }
  driftlab::cli::HttpClient::trust(ca_file);
  driftlab::cli::HttpClient::use_token(std::move(*token));
  driftlab::cli::watch_interrupts();
  return static_cast<int>(chosen());
}
