#pragma once
/// --skip-lines and --comment: lines of a text that are left out before it is read or sent.
#include "clients/cli/input.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own
class App;
}

namespace driftlab::cli {

/// Adds both flags, the same for every command that reads recordings.
void add_left_out_lines(CLI::App& command, FileFlags& flags);

/// Gives each file of `inputs` a copy in which these lines are comments, so that every other line keeps its number, and
/// says on standard error how many there are. Nothing where no flag asks for it. Errors: NotFound, InvalidArgument (a
/// packed file, or fewer lines than are to be left out), Io.
[[nodiscard]] Status leave_out_lines(const FileFlags& flags, Inputs& inputs);

}  // namespace driftlab::cli
