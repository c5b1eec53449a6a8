#pragma once
/// Commands that show one page of the daemon.
#include "clients/cli/cli.hpp"

#include <string>

namespace driftlab::cli {

/// Prints what the daemon answers to GET `target`, or complains in the words of its problem document: bad input where
/// the request was at fault, else server. Recordings that are still being pooled are waited for.
[[nodiscard]] Exit print_answer(const std::string& server, const std::string& target, const std::string& accept);

}  // namespace driftlab::cli
