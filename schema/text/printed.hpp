#pragma once
/// Text by a format, and numbers with fewer digits than they have.
#include <string>

namespace driftlab {

/// As printf, into a string of at most 1023 bytes.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string printed(const char* format, ...);

/// Four significant digits, without an exponent where people would not write one.
[[nodiscard]] std::string to_four_digits(double value);

/// Rounded to tenths, without a tenth that is zero: 3.1, 3.
[[nodiscard]] std::string in_tenths(double value);

}  // namespace driftlab
