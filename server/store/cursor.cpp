#include "server/store/cursor.hpp"

namespace driftlab::server {
namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";

std::string hexadecimal(std::string_view text) {
  std::string digits;
  for (const char c : text) {
    digits += kHexDigits[static_cast<unsigned char>(c) >> 4U];
    digits += kHexDigits[static_cast<unsigned char>(c) & 15U];
  }
  return digits;
}

std::optional<std::string> from_hexadecimal(std::string_view digits) {
  std::string text;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    const std::size_t high = kHexDigits.find(digits[i]);
    const std::size_t low = kHexDigits.find(digits[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) {
      return std::nullopt;
    }
    text += static_cast<char>(high << 4U | low);
  }
  return digits.size() % 2 == 0 ? std::optional(text) : std::nullopt;
}

bool is_of_a_row(std::string_view id) {
  const std::size_t underscore = id.find('_');
  return underscore != std::string_view::npos && is_id(id, id.substr(0, underscore));
}

}  // namespace

std::optional<Cursor> read_cursor(std::string_view text, PageOrder order) {
  const std::size_t dot = order == PageOrder::ByName ? text.find('.') : text.size();
  if (dot == std::string_view::npos || !is_of_a_row(text.substr(0, dot))) {
    return std::nullopt;
  }
  auto name = dot == text.size() ? std::optional<std::string>("") : from_hexadecimal(text.substr(dot + 1));
  return name ? std::optional(Cursor{std::string(text.substr(0, dot)), std::move(*name)}) : std::nullopt;
}

std::string cursor_at(PageOrder order, const std::string& id, const std::string& name) {
  return order == PageOrder::ByName && !id.empty() ? id + '.' + hexadecimal(name) : id;
}

}  // namespace driftlab::server
