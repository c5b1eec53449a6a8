#pragma once
/// Numbers in text, both ways, without locale and without loss.
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab {

/// The whole of `text` as a double; nothing if any character is left over, or the value is not representable.
[[nodiscard]] inline std::optional<double> parse_double(std::string_view text) {
  double value = 0.0;
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end) {
    return std::nullopt;
  }
  return value;
}

/// Shortest decimal text that reads back to the same bits.
[[nodiscard]] inline std::string to_text(double value) {
  char buffer[32];
  const auto [stop, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc{} ? std::string(buffer, stop) : std::string("nan");
}

/// Six digits, for a sentence.
[[nodiscard]] inline std::string short_text(double value) {
  char buffer[32];
  const auto [stop, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
  return error == std::errc{} ? std::string(buffer, stop) : std::string("?");
}

}  // namespace driftlab
