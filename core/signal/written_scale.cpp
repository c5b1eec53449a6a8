#include "core/signal/written_scale.hpp"

#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace driftlab {
namespace {

constexpr std::size_t kLongest = 100;  ///< characters; a longer text is a name

constexpr std::array<std::string_view, 10> kCounts{"raw",  "LSB",   "lsb",    "LSb",   "LSBs",
                                                   "lsbs", "count", "counts", "digit", "digits"};

using IsUnit = std::function<bool(std::string_view)>;

/// The number at the start of `text`, which is moved past it. A sign belongs to it where it stands there.
std::optional<double> take_number(std::string_view& text) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) {
    return std::nullopt;
  }
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

/// `*2.5`, `/ 340 + 36.53`, `+36.53`, `/340 36.53` at the start of `text`, which is moved past what is read; nothing
/// where an operator has no number. `scaled`: a scale stands before it. Without one a number behind a blank is no
/// offset but may be the range of the sensor (`deg/s 500`).
std::optional<WrittenScale> take_affine(std::string_view& text, bool scaled = false) {
  WrittenScale found;
  text = trimmed(text);
  if (!text.empty() && (text.front() == '*' || text.front() == '/')) {
    const bool divides = text.front() == '/';
    text = trimmed(text.substr(1));
    const auto number = take_number(text);
    if (!number) {
      return std::nullopt;
    }
    found.scale = divides ? 1.0 / *number : *number;
    scaled = true;
  }
  text = trimmed(text);
  const char sign = text.empty() ? '\0' : text.front();
  if (sign == '+' || sign == '-' || (scaled && sign >= '0' && sign <= '9')) {
    if (sign == '+' || sign == '-') {
      text = trimmed(text.substr(1));
    }
    const auto number = text.starts_with('-') ? std::nullopt : take_number(text);
    if (!number) {
      return std::nullopt;
    }
    found.offset = sign == '-' ? -*number : *number;
  }
  text = trimmed(text);
  return found;
}

/// `raw/340+36.53 degC`. What stands behind the word is apart from it: `LSBs` and `digits` are plurals, no counts of a
/// second.
std::optional<WrittenScale> formula_first(std::string_view text, const IsUnit& is_unit) {
  for (const std::string_view word : kCounts) {
    std::string_view rest = text;
    if (!rest.starts_with(word)) {
      continue;
    }
    rest.remove_prefix(word.size());
    if (rest.empty() || std::string_view("*/+- \t").find(rest.front()) == std::string_view::npos) {
      continue;
    }
    auto found = take_affine(rest);
    if (found && is_unit(rest)) {
      found->unit = rest;
      return found;
    }
  }
  return std::nullopt;
}

/// `deg/s/131`, `degC/340+36.53`: the longest unit behind which nothing but a scale and an offset stands.
std::optional<WrittenScale> unit_first(std::string_view text, const IsUnit& is_unit) {
  for (std::size_t end = text.size(); end > 1; --end) {
    const std::size_t at = end - 1;
    if (std::string_view("/*+- ").find(text[at]) == std::string_view::npos || !is_unit(trimmed(text.substr(0, at)))) {
      continue;
    }
    std::string_view rest = text.substr(at);
    auto found = take_affine(rest);
    if (found && rest.empty()) {
      found->unit = trimmed(text.substr(0, at));
      return found;
    }
  }
  return std::nullopt;
}

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  return text.size() > 2 && text.front() == '(' && text.back() == ')' ? trimmed(text.substr(1, text.size() - 2)) : text;
}

bool is_count(std::string_view word) { return std::find(kCounts.begin(), kCounts.end(), word) != kCounts.end(); }

/// What a number stands before: `mg`, `LSB/(deg/s)` or `mg/LSB`. Nothing else has a unit. Without a blank between them
/// (`131LSB/dps`) it takes the word for a count: `2g` alone may be the range of the sensor.
std::optional<WrittenScale> sized(double number, std::string_view text, const IsUnit& is_unit, bool apart) {
  WrittenScale found;
  found.scale = number;
  const std::size_t first = text.find('/');
  const std::size_t last = text.rfind('/');
  if (first != std::string_view::npos && is_count(trimmed(text.substr(0, first)))) {
    found.scale = 1.0 / number;
    text = without_brackets(text.substr(first + 1));
  } else if (last != std::string_view::npos && is_count(trimmed(text.substr(last + 1)))) {
    text = without_brackets(text.substr(0, last));
  } else if (!apart) {
    return std::nullopt;
  }
  found.unit = trimmed(text);
  return is_unit(found.unit) && !found.unit.empty() ? std::optional(found) : std::nullopt;
}

/// `0.061 mg`, `131LSB/dps`, `340 LSB/degC + 36.53`
std::optional<WrittenScale> number_first(std::string_view text, const IsUnit& is_unit) {
  std::string_view rest = text;
  const auto number = take_number(rest);
  if (!number) {
    return std::nullopt;
  }
  const bool apart = rest.starts_with(' ');
  rest = trimmed(rest);
  if (auto found = sized(*number, rest, is_unit, apart)) {
    return found;
  }
  for (std::size_t at = rest.size(); at-- > 1;) {
    if (std::string_view("+- ").find(rest[at]) == std::string_view::npos) {
      continue;
    }
    std::string_view tail = rest.substr(at);
    const auto shift = take_affine(tail, true);
    auto found = shift && tail.empty() ? sized(*number, trimmed(rest.substr(0, at)), is_unit, apart) : std::nullopt;
    if (found) {
      found->offset = shift->offset;
      return found;
    }
  }
  return std::nullopt;
}

/// With `+` before an offset that stands behind a blank.
std::string with_plus(std::string_view text) {
  std::string result(text);
  for (std::size_t at = result.size(); at-- > 1;) {
    const char next = at + 1 < result.size() ? result[at + 1] : '\0';
    const std::string_view before = trimmed(std::string_view(result).substr(0, at));
    const bool after_operator =
        !before.empty() && std::string_view("/*+-").find(before.back()) != std::string_view::npos;
    if (result[at] == ' ' && next >= '0' && next <= '9' && !after_operator) {
      result[at] = '+';
      break;
    }
  }
  return result;
}

}  // namespace

std::optional<WrittenScale> read_scale(std::string_view text, const IsUnit& is_unit) {
  if (text.size() > kLongest) {
    return std::nullopt;
  }
  auto found = formula_first(text, is_unit);
  if (!found) {
    found = unit_first(text, is_unit);
  }
  if (!found) {
    found = number_first(text, is_unit);
  }
  if (found) {
    found->canonical = found->offset != 0.0 ? with_plus(text) : std::string(text);
  }
  return found;
}

}  // namespace driftlab
