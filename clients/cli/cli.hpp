#pragma once
/// The command line: shared pieces of all commands. Each command is one file that adds itself to the application, and
/// one line of the list in commands.cpp.
#include "core/signal/result.hpp"

#include <functional>
#include <stop_token>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own
class App;
}

namespace driftlab::cli {

/// Exit codes of every command (spec/results.md).
/// Inconclusive is that of a regression run which decides nothing.
enum class Exit : int { Success = 0, Negative = 1, BadInput = 2, Inconclusive = 3, ServerOrJob = 4, Interrupted = 130 };

/// The sentence that a person reads of an error, with the place of the fault where it does not name it.
[[nodiscard]] std::string sentence_of(const Error& error);

/// Prints one sentence on standard error and says how the process ends.
[[nodiscard]] Exit complain(const Error& error);
[[nodiscard]] Exit complain(const Error& error, Exit exit);
/// The same for what went wrong in this process: Interrupted where it was cancelled, else BadInput.
[[nodiscard]] Exit complain_of_work(const Error& error);

/// A command runs after parsing; its exit code is the process's.
using Command = std::function<Exit()>;

/// Adds every subcommand; the one that is chosen sets `chosen`.
void add_all_commands(CLI::App& app, Command& chosen);

/// Stops on Ctrl-C: `interrupt_token` is requested at the first SIGINT or SIGTERM, the second ends the process.
/// Call once, before threads start.
void watch_interrupts();
[[nodiscard]] std::stop_token interrupt_token();

}  // namespace driftlab::cli
