#include "server/http/byte_range.hpp"

#include "core/signal/text.hpp"
#include "server/http/names.hpp"

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

/// Digits alone; a number beyond 2^64 is the greatest there is. Nothing for anything else.
std::optional<std::uint64_t> position(std::string_view text) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || stop != text.data() + text.size() || error == std::errc::invalid_argument) {
    return std::nullopt;
  }
  return error == std::errc::result_out_of_range ? UINT64_MAX : value;
}

}  // namespace

WantedBytes wanted_bytes(const Request& request, std::uint64_t size, std::string_view etag) {
  constexpr std::string_view kUnit = "bytes=";
  const WantedBytes whole{WantedBytes::Kind::Whole, 0, size};
  const auto range = request.header("range");
  const auto condition = request.header("if-range");
  if (request.method != "GET" || !range || (condition && trimmed(*condition) != etag) ||
      !same_name(range->substr(0, kUnit.size()), kUnit)) {
    return whole;
  }
  const std::string_view wanted = trimmed(range->substr(kUnit.size()));
  const std::size_t dash = wanted.find('-');
  if (dash == std::string_view::npos || wanted.find(',') != std::string_view::npos) {
    return whole;
  }
  const auto first = position(wanted.substr(0, dash));
  const auto last = position(wanted.substr(dash + 1));
  if (dash == 0) {  // the last bytes, as many as said
    if (!last) {
      return whole;
    }
    const std::uint64_t length = std::min(*last, size);
    return {length > 0 ? WantedBytes::Kind::Part : WantedBytes::Kind::None, size - length, length};
  }
  const bool open = dash + 1 == wanted.size();
  if (!first || (!open && (!last || *last < *first))) {
    return whole;
  }
  if (*first >= size) {
    return {WantedBytes::Kind::None, 0, 0};
  }
  const std::uint64_t end = open ? size : std::min(*last, size - 1) + 1;
  return {WantedBytes::Kind::Part, *first, end - *first};
}

}  // namespace driftlab::server
