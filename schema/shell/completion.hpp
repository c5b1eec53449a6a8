#pragma once
/// Shell completion of a program, from the same source as its --help: commands, flags, and the values of those that
/// take one out of a few. Where a flag takes another value, the shell offers files.
#include "schema/shell/command_tree.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace driftlab {

/// A script for `bash`, `zsh` or `fish`; nothing for another shell.
[[nodiscard]] std::optional<std::string> completion_script(const ProgramCommand& program, std::string_view shell);

}  // namespace driftlab
