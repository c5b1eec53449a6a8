#pragma once

#include <string_view>

namespace driftlab::server {

/// Whether two names of HTTP are one: header fields, media types, codings and units of ranges are compared without
/// regard to the case of ASCII letters (RFC 9110, section 5.1). Neither view need end in a byte of its own.
///
/// Beast 1.81 has `iequals` and Boost.URL `ci_is_equal`: where two names differ in case, both read the byte behind the
/// last one of either view.
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

}  // namespace driftlab::server
