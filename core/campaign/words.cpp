#include "core/campaign/words.hpp"

#include <array>
#include <string_view>

namespace driftlab {
namespace {

constexpr std::array<std::string_view, 13> kCounts{"no",    "one",   "two",  "three", "four",   "five",  "six",
                                                   "seven", "eight", "nine", "ten",   "eleven", "twelve"};

}  // namespace

std::string counted(std::size_t n) { return n < kCounts.size() ? std::string(kCounts[n]) : std::to_string(n); }

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  return text;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return text;
}

}  // namespace driftlab
