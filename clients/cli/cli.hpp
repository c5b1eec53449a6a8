#pragma once
/// The command line: shared pieces of all commands. Each command is one file that adds itself to the application.
#include "core/signal/result.hpp"

#include <functional>
#include <stop_token>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own
class App;
}

namespace driftlab::cli {

/// Exit codes of every command (spec/results.md).
enum class Exit : int { Success = 0, Negative = 1, BadInput = 2, ServerOrJob = 4, Interrupted = 130 };

/// Prints one sentence on standard error and says how the process ends.
[[nodiscard]] Exit complain(const Error& error);
[[nodiscard]] Exit complain(const Error& error, Exit exit);

/// A command runs after parsing; its exit code is the process's.
using Command = std::function<Exit()>;

/// Each adds a subcommand whose choice sets `chosen`.
void add_characterise(CLI::App& app, Command& chosen);
void add_table(CLI::App& app, Command& chosen);
void add_trends(CLI::App& app, Command& chosen);
void add_investigate(CLI::App& app, Command& chosen);
void add_simulate(CLI::App& app, Command& chosen);
void add_calibrate(CLI::App& app, Command& chosen);
void add_outages(CLI::App& app, Command& chosen);

/// Stops on Ctrl-C: `interrupt_token` is requested at the first SIGINT or SIGTERM, the second ends the process.
/// Call once, before threads start.
void watch_interrupts();
[[nodiscard]] std::stop_token interrupt_token();

}  // namespace driftlab::cli
