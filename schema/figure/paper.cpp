#include "schema/figure/paper.hpp"

#include "core/signal/text.hpp"

#include <algorithm>

namespace driftlab::figure {
namespace {

// Text of a fixed width, in tenths of a pixel of its size: between the margins of A4 lie 178 mm, 672 pixels at 96 an
// inch, and a character of the fonts of `pre` is 0.61 of the size wide.
constexpr std::size_t kPaperAdvances = 11016;
constexpr std::size_t kLargest = 110;
constexpr std::size_t kSmallest = 60;  // read with an effort; a longer line wraps

}  // namespace

std::size_t aligned_type_tenths(std::string_view text) {
  // What is aligned by blanks falls apart where a line wraps; sentences may.
  std::size_t longest = 1;
  for (const std::string_view line : split(text, '\n')) {
    const bool row = line.find("  ") != std::string_view::npos;
    const auto characters = static_cast<std::size_t>(std::count_if(
        line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
    longest = row ? std::max(longest, characters) : longest;
  }
  return std::clamp(kPaperAdvances / longest, kSmallest, kLargest);
}

std::string aligned_type_size(std::string_view text) {
  const std::size_t tenths = aligned_type_tenths(text);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + "px";
}

}  // namespace driftlab::figure
