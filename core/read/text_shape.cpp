#include "core/read/text_shape.hpp"

#include "core/read/decimal.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

namespace driftlab::text {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7F;
}

bool ends_lines_with_returns(std::string_view head) {
  return head.find('\n') == std::string_view::npos && trim(head).find('\r') != std::string_view::npos &&
         std::none_of(head.begin(), head.end(), is_control);
}

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return trim(line);
}

/// The next line that is neither blank nor a comment; empty at the end.
std::string_view take_content(std::string_view& rest) {
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    if (!line.empty() && line.front() != '#' && line.front() != '%' && !line.starts_with("//")) {
      return line;
    }
  }
  return {};
}

std::size_t count_unquoted(std::string_view line, char wanted) {
  std::size_t count = 0;
  bool quoted = false;
  for (const char c : line) {
    quoted = quoted != (c == '"');
    count += !quoted && c == wanted ? 1 : 0;
  }
  return count;
}

/// True if `line`, cut at `separator`, is numbers only, written with a decimal comma.
bool is_decimal_comma_row(std::string_view line, char separator) {
  while (true) {
    const std::size_t cut = line.find(separator);
    std::string cell(trim(line.substr(0, cut)));
    std::replace(cell.begin(), cell.end(), ',', '.');
    if (!is_number(cell)) {
      return false;
    }
    if (cut == std::string_view::npos) {
      return true;
    }
    line.remove_prefix(cut + 1);
  }
}

bool separates(char separator, std::string_view line) {
  return count_unquoted(line, separator) > 0 &&
         (count_unquoted(line, ',') == 0 || is_decimal_comma_row(line, separator));
}

/// Numbers with blanks between them, at least `least`.
bool is_spaced_numbers(std::string_view line, std::size_t least) {
  std::size_t count = 0;
  line = trim(line);
  while (!line.empty()) {
    const std::size_t cut = std::min(line.find_first_of(" \t"), line.size());
    if (!is_number(line.substr(0, cut))) {
      return false;
    }
    ++count;
    line = trim(line.substr(cut));
  }
  return count >= least;
}

}  // namespace

Shape shape_of(std::string_view head) {
  if (head.starts_with(kByteOrderMark)) {
    head.remove_prefix(kByteOrderMark.size());
  }
  if (ends_lines_with_returns(head)) {
    return Shape::LoneReturns;
  }
  const std::string_view first = take_content(head);
  if (std::any_of(first.begin(), first.end(), is_control)) {
    return Shape::NotText;
  }
  if (first.empty() || first.front() == '<' || first.front() == '{' || first.front() == '[') {
    return Shape::NotATable;
  }
  if (separates(';', first)) {
    return Shape::Semicolons;
  }
  if (separates('\t', first)) {
    return Shape::Tabs;
  }
  if (count_unquoted(first, ',') > 0) {
    return Shape::Commas;
  }
  const std::string_view second = take_content(head);
  if (is_spaced_numbers(first, 2) || is_spaced_numbers(second, 2)) {
    return Shape::Spaces;
  }
  constexpr std::string_view kStartsNumber = "+-.0123456789nNiI\"";
  const bool named = first.size() <= 256 && (second.empty() ? first.find(' ') == std::string_view::npos
                                                            : kStartsNumber.find(second.front()) != kStartsNumber.npos);
  return is_number(first) || named ? Shape::SingleColumn : Shape::NotATable;
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

bool is_non_finite_word(std::string_view text) {
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    text.remove_prefix(1);
  }
  constexpr std::array<std::string_view, 3> kWords{"nan", "inf", "infinity"};
  return std::any_of(kWords.begin(), kWords.end(), [text](std::string_view word) {
    return std::equal(word.begin(), word.end(), text.begin(), text.end(),
                      [](char a, char b) { return a == lower_case(b); });
  });
}

bool is_number(std::string_view text) {
  double value = 0.0;
  const std::string terminated(text);
  return decimal::parse(terminated.c_str(), value) == terminated.c_str() + terminated.size() ||
         is_non_finite_word(text);
}

namespace {

/// The digits of `text` from `at` on, `count` of them; -1 if they are not all digits.
int digits_at(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  for (std::size_t i = at; i < at + count; ++i) {
    if (i >= text.size() || !decimal::is_digit(text[i])) {
      return -1;
    }
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

/// Seconds east of Greenwich of `Z`, `+hh:mm`, `-hhmm` or nothing.
std::optional<int> zone_of(std::string_view text) {
  if (text.empty() || text == "Z") {
    return 0;
  }
  const int hours = digits_at(text, 1, 2);
  const int minutes = text.size() == 6 && text[3] == ':' ? digits_at(text, 4, 2)
                      : text.size() == 5                 ? digits_at(text, 3, 2)
                                                         : -1;
  if ((text[0] != '+' && text[0] != '-') || hours < 0 || hours > 14 || minutes < 0 || minutes > 59) {
    return std::nullopt;
  }
  return (text[0] == '-' ? -1 : 1) * (3600 * hours + 60 * minutes);
}

/// The fraction of a second that begins at `at` with a point; `at` is then behind it.
double fraction_at(std::string_view text, std::size_t& at) {
  double fraction = 0.0;
  if (at < text.size() && text[at] == '.') {
    double place = 0.1;
    for (++at; at < text.size() && decimal::is_digit(text[at]); ++at, place *= 0.1) {
      fraction += place * (text[at] - '0');
    }
  }
  return fraction;
}

/// `20250614T211702.5` as `2025-06-14T21:17:02.5`; any other text as it is.
std::string with_marks(std::string_view text) {
  std::string date(text);
  if (date.size() >= 15 && date[8] == 'T' && digits_at(date, 0, 8) >= 0 && digits_at(date, 9, 6) >= 0) {
    date.insert(13, ":").insert(11, ":").insert(6, "-").insert(4, "-");
  }
  return date;
}

}  // namespace

std::optional<double> seconds_of_day(std::string_view text) {
  const std::size_t hours = text.find(':') == 1 ? 1 : 2;
  const int hour = digits_at(text, 0, hours);
  const int minute = digits_at(text, hours + 1, 2);
  const int second = digits_at(text, hours + 4, 2);
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 60 || text[hours] != ':' ||
      text[hours + 3] != ':') {
    return std::nullopt;
  }
  std::size_t at = hours + 6;
  const double fraction = fraction_at(text, at);
  return at == text.size() ? std::optional(3600 * hour + 60 * minute + second + fraction) : std::nullopt;
}

std::optional<double> seconds_of_date(std::string_view written) {
  const std::string date_and_time = with_marks(written);
  const std::string_view text = date_and_time;
  const int year = digits_at(text, 0, 4);
  const int month = digits_at(text, 5, 2);
  const int day = digits_at(text, 8, 2);
  const int hour = digits_at(text, 11, 2);
  const int minute = digits_at(text, 14, 2);
  const int second = digits_at(text, 17, 2);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (year < 1900 || month < 0 || day < 0 || !date.ok() || hour < 0 || hour > 23 || minute < 0 || minute > 59 ||
      second < 0 || second > 60 || (text[4] != '-' && text[4] != '/') || text[7] != text[4] ||
      (text[10] != ' ' && text[10] != 'T') || text[13] != ':' || text[16] != ':') {
    return std::nullopt;
  }
  std::size_t at = 19;
  const double fraction = fraction_at(text, at);
  const auto zone = zone_of(text.substr(at));
  if (!zone) {
    return std::nullopt;
  }
  const int within_day = 3600 * hour + 60 * minute + second;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(86400 * days + within_day - *zone) + fraction;
}

std::string excerpt(std::string_view cell) {
  constexpr std::size_t kMost = 32;
  std::string shown = "'";
  for (const char c : cell.substr(0, kMost)) {
    shown += c >= 0x20 && c < 0x7F ? c : '?';
  }
  return shown + (cell.size() > kMost ? "...'" : "'");
}

namespace {

/// Bytes of the well-formed UTF-8 sequence at the front of `text`, 0 if there is none (Unicode 15, table 3-7).
std::size_t utf8_length(std::string_view text) {
  const auto at = [text](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned lead = at(0);
  if (lead < 0x80) {
    return 1;
  }
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : lead >= 0xE0 && lead <= 0xEF ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0U) != 0x80) {
      return 0;
    }
  }
  const bool overlong = (lead == 0xE0 && at(1) < 0xA0) || (lead == 0xF0 && at(1) < 0x90);
  const bool surrogate_or_beyond = (lead == 0xED && at(1) > 0x9F) || (lead == 0xF4 && at(1) > 0x8F);
  return overlong || surrogate_or_beyond ? 0 : length;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      return false;
    }
    text.remove_prefix(length);
  }
  return true;
}

void append_latin1(char c, std::string& converted) {
  const auto byte = static_cast<unsigned char>(c);
  if (byte < 0x80) {
    converted += c;
  } else {
    converted += static_cast<char>(0xC0U | (byte >> 6U));
    converted += static_cast<char>(0x80U | (byte & 0x3FU));
  }
}

}  // namespace

std::string to_utf8(std::string_view text) {
  if (is_utf8(text)) {
    return std::string(text);
  }
  std::string converted;
  for (const char c : text) {
    append_latin1(c, converted);
  }
  return converted;
}

std::string mended_utf8(std::string_view text) {
  std::string mended;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      append_latin1(text.front(), mended);
    } else {
      mended += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return mended;
}

std::string_view front_of(std::string_view text, std::size_t most) {
  std::size_t end = std::min(most, text.size());
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80) {
    --end;
  }
  return text.substr(0, end);
}

}  // namespace driftlab::text
