#pragma once
/// The error that a client receives, without the paths of the daemon's files; the operator finds those in the log.
#include "core/signal/result.hpp"

#include <string_view>

namespace driftlab::server {

/// Stands where the path of a file stood.
inline constexpr std::string_view kNamedInTheLog = "[a file that the log names]";

/// The same error without absolute paths. A field that holds one (`path`) is left out, and what it says is replaced in
/// the sentence and in the other fields; the sentences of errors that are the daemon's own (Io, DiskFull, Internal)
/// lose every other path too, for a library may have put one in. Paths of this API (`/v1/...`, `/docs`) stay.
[[nodiscard]] Error without_paths(const Error& error);

}  // namespace driftlab::server
