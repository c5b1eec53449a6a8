/// The list of commands: one line each, which names the function that adds it. Each is defined in the file of its name.
#include "clients/cli/cli.hpp"

// clang-format off
#define DRIFTLAB_COMMANDS(COMMAND) \
  COMMAND(add_characterise)        \
  COMMAND(add_table)               \
  COMMAND(add_trends)              \
  COMMAND(add_investigate)         \
  COMMAND(add_plan)                \
  COMMAND(add_simulate)            \
  COMMAND(add_calibrate)           \
  COMMAND(add_plot)                \
  COMMAND(add_report)              \
  COMMAND(add_export)              \
  COMMAND(add_datasheet)           \
  COMMAND(add_population)          \
  COMMAND(add_outages)             \
  COMMAND(add_regress)             \
  COMMAND(add_ci)                  \
  COMMAND(add_drive)               \
  COMMAND(add_convert)             \
  COMMAND(add_watch)               \
  COMMAND(add_api)                 \
  COMMAND(add_manual)
// clang-format on

namespace driftlab::cli {

#define DRIFTLAB_DECLARE_COMMAND(add) void add(CLI::App& app, Command& chosen);
DRIFTLAB_COMMANDS(DRIFTLAB_DECLARE_COMMAND)
#undef DRIFTLAB_DECLARE_COMMAND

void add_all_commands(CLI::App& app, Command& chosen) {
#define DRIFTLAB_ADD_COMMAND(add) add(app, chosen);
  DRIFTLAB_COMMANDS(DRIFTLAB_ADD_COMMAND)
#undef DRIFTLAB_ADD_COMMAND
}

}  // namespace driftlab::cli
