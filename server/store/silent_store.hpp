#pragma once
/// A database of the store, or an object storage of its recordings, that does not answer for now: it starts, is cut
/// off, or has no connection left.
#include "core/signal/result.hpp"

#include <string>
#include <vector>

namespace driftlab::server {

/// An error of code Io that answers map to 503 (server/http/problem.hpp), and whether one is.
[[nodiscard]] Error silent_store(std::string message, std::vector<ErrorField> fields = {});
[[nodiscard]] bool is_silent_store(const Error& error);

}  // namespace driftlab::server
