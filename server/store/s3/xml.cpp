#include "server/store/s3/xml.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace driftlab::server::s3 {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};

/// One entity without `&` and `;`; what is none stays as it is.
std::string resolved(std::string_view entity) {
  for (const auto& [name, letter] : kEntities) {
    if (entity == name) {
      return {letter};
    }
  }
  if (entity.starts_with('#')) {
    const bool hexadecimal = entity.substr(1).starts_with('x');
    const std::string_view digits = entity.substr(hexadecimal ? 2 : 1);
    unsigned code = 0;
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
    if (error == std::errc{} && stop == digits.data() + digits.size() && code < 128) {
      return {static_cast<char>(code)};
    }
  }
  return "&" + std::string(entity) + ";";
}

}  // namespace

std::vector<std::string_view> elements(std::string_view document, std::string_view name) {
  std::vector<std::string_view> found;
  const std::string begin = "<" + std::string(name);
  const std::string end = "</" + std::string(name) + ">";
  for (std::size_t at = document.find(begin); at != std::string_view::npos; at = document.find(begin, at)) {
    const std::size_t after = at + begin.size();
    const std::size_t open = document.find('>', after);
    if (open == std::string_view::npos) {
      break;
    }
    const char next = document[after];
    if (next != '>' && next != ' ' && next != '/') {  // a longer name
      at = after;
      continue;
    }
    if (document[open - 1] == '/') {
      found.push_back(document.substr(open, 0));
      at = open;
      continue;
    }
    const std::size_t close = document.find(end, open);
    if (close == std::string_view::npos) {
      break;
    }
    found.push_back(document.substr(open + 1, close - open - 1));
    at = close;
  }
  return found;
}

std::optional<std::string> element_text(std::string_view document, std::string_view name) {
  const auto found = elements(document, name);
  if (found.empty()) {
    return std::nullopt;
  }
  std::string text;
  std::string_view rest = found.front();
  while (!rest.empty()) {
    const std::size_t begin = rest.find('&');
    const std::size_t end = rest.find(';', begin == std::string_view::npos ? rest.size() : begin);
    if (end == std::string_view::npos) {
      break;
    }
    text.append(rest.substr(0, begin)).append(resolved(rest.substr(begin + 1, end - begin - 1)));
    rest.remove_prefix(end + 1);
  }
  return text.append(rest);
}

}  // namespace driftlab::server::s3
