#pragma once
/// Text by a format.
#include <string>

namespace driftlab {

/// As printf, into a string of at most 1023 bytes.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string printed(const char* format, ...);

}  // namespace driftlab
