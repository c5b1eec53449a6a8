#include "schema/text/printed.hpp"

#include "core/signal/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace driftlab {

std::string printed(const char* format, ...) {
  std::array<char, 1024> buffer{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return buffer.data();
}

std::string to_four_digits(double value) {
  const double size = std::fabs(value);
  const bool plain = size == 0.0 || (size >= 1e-3 && size < 1e5);
  int decimals = 0;
  if (plain && size > 0.0) {
    decimals = std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
  }
  return plain ? printed("%.*f", decimals, value) : printed("%.3e", value);
}

std::string in_tenths(double value) { return short_text(std::round(10.0 * value) / 10.0); }

}  // namespace driftlab
