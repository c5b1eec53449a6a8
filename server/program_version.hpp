#pragma once
/// The version of the program that runs, in a file of its own: tests link a later release from the same objects.
#include <string_view>

namespace driftlab::server {

/// `0.1.0`
[[nodiscard]] std::string_view program_version();

}  // namespace driftlab::server
