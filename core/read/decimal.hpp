#pragma once
/// Decimal text to the nearest double, fast for the numbers recordings are made of. Internal to core/read.
///
/// A number m * 10^e with an integer m <= 2^53 and |e| <= 22 has both factors exactly representable, so one IEEE
/// multiplication or division rounds it correctly (Clinger 1990, "How to read floating point numbers accurately",
/// section 5). Everything else goes to std::from_chars, which rounds correctly too: the result is the same bits always.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

namespace driftlab::decimal {

inline constexpr std::array<double, 23> kExactPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

[[nodiscard]] inline bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// The slow way, correct for every input: [first, last) is the text of a number that scan() has accepted.
/// Beyond the range of double: the infinity or zero it rounds to.
template <char Point>
[[nodiscard]] double from_text(const char* first, const char* last, bool large) {
  double value = 0.0;
  std::string copy;  // NOLINT(misc-const-correctness): assigned for another point
  if constexpr (Point != '.') {
    copy.assign(first, last);
    std::replace(copy.begin(), copy.end(), Point, '.');
    first = copy.data();
    last = first + copy.size();
  }
  const auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::result_out_of_range) {
    const double magnitude = large ? std::numeric_limits<double>::infinity() : 0.0;
    return *first == '-' ? -magnitude : magnitude;
  }
  return value;
}

/// Reads the longest number `[+-]digits[.digits][(e|E)[+-]digits]` (digits on one side of the point may be missing)
/// that starts at `text`. Returns the character behind it, or nullptr if no number starts there; `nan`, `inf` and
/// hexadecimal are no numbers here. A number too large for a double gives an infinity, one too small a zero, with its
/// sign. Precondition: some readable character after the number ends it (a line feed, a NUL); the scan stops at the
/// first character that cannot continue a number. `Point` is the decimal sign.
template <char Point = '.'>
[[nodiscard]] const char* parse(const char* text, double& value) {
  const bool negative = *text == '-';
  const char* const number = text + (*text == '+' ? 1 : 0);  // from_chars knows no plus sign
  const char* p = text + (negative || *text == '+' ? 1 : 0);
  const char* const digits = p;
  std::uint64_t mantissa = 0;  // wraps beyond 19 digits; then it is not used
  while (is_digit(*p)) {
    mantissa = mantissa * 10 + static_cast<std::uint64_t>(*p++ - '0');
  }
  const std::int64_t integer_digits = p - digits;
  std::int64_t exponent = 0;
  if (*p == Point) {
    const char* const fraction = ++p;
    while (is_digit(*p)) {
      mantissa = mantissa * 10 + static_cast<std::uint64_t>(*p++ - '0');
    }
    exponent = fraction - p;
  }
  std::int64_t significant = integer_digits - exponent;
  if (significant == 0) {
    return nullptr;
  }
  if ((*p | 0x20) == 'e') {
    const char* q = p + 1;
    const bool minus = *q == '-';
    q += minus || *q == '+' ? 1 : 0;
    if (is_digit(*q)) {
      std::int64_t written = 0;
      for (; is_digit(*q); ++q) {
        written = written < 100000 ? written * 10 + (*q - '0') : written;
      }
      exponent += minus ? -written : written;
      p = q;
    }
  }
  if (significant > 19) {  // leading zeros do not count
    for (const char* q = digits; *q == '0' || *q == Point; ++q) {
      significant -= *q == '0' ? 1 : 0;
    }
  }
  constexpr std::uint64_t kExactIntegers = std::uint64_t{1} << 53;
  if (significant <= 19 && mantissa <= kExactIntegers && exponent >= -22 && exponent <= 22) [[likely]] {
    const auto exact = static_cast<double>(mantissa);
    const double magnitude = exponent < 0 ? exact / kExactPowers[static_cast<std::size_t>(-exponent)]
                                          : exact * kExactPowers[static_cast<std::size_t>(exponent)];
    value = negative ? -magnitude : magnitude;
    return p;
  }
  value = from_text<Point>(number, p, significant + exponent > 0);
  return p;
}

}  // namespace driftlab::decimal
