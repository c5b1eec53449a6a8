#pragma once
/// What the writers of SVG share.
#include <string>

namespace driftlab::figure {

/// A text with what SVG would take for markup escaped.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace driftlab::figure
