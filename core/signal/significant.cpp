#include "core/signal/significant.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace driftlab {
namespace {

constexpr int kDigits = 3;  // without an interval

int exponent_of(double x) { return static_cast<int>(std::floor(std::log10(x))); }

/// The power of ten of the last digit that an interval of half length `half` lets stand.
int last_digit(double half) {
  const int e = exponent_of(half);
  const bool begins_with_one = std::floor(half / std::pow(10.0, e) + 1e-9) <= 1.0;
  return begins_with_one ? e - 1 : e;
}

/// What rounds to zero has no sign.
std::string printed(double value, int decimals) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", std::clamp(decimals, 0, 20), value);
  std::string text = buffer;
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

std::string rounded(double value, int last) {
  if (last < 0) {
    return printed(value, -last);
  }
  const double step = std::pow(10.0, last);
  return printed(std::round(value / step) * step, 0);
}

}  // namespace

std::string significant(double value, std::optional<double> low, std::optional<double> high) {
  const double size = std::fabs(value);
  if (size == 0.0 || !std::isfinite(value)) {
    return size == 0.0 ? "0" : "?";
  }
  const bool bounded = low && high && *high > *low;
  const int e = exponent_of(size);
  const int last = bounded ? last_digit((*high - *low) / 2.0) : e - kDigits + 1;
  if (e < -4 || e >= 7) {
    return rounded(value / std::pow(10.0, e), std::min(last - e, 0)) + "e" + std::to_string(e);
  }
  return rounded(value, bounded ? last : std::min(last, 0));
}

}  // namespace driftlab
