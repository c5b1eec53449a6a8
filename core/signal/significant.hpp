#pragma once
/// Numbers as people write them: the 95 % interval decides which digits are shown.
///
/// With h half the length of the interval and 10^e the power of its first digit, the last digit shown is that of 10^e,
/// or of 10^(e-1) where the first digit of h is 1: 1.0382 [1.0347, 1.0417] is 1.038, and 297.3 [180.1, 467.2] is 300.
/// Without an interval three significant digits are shown. What rounds to zero has no sign. schema/number-format.json
/// holds the cases that every writer keeps to.
#include <optional>
#include <string>

namespace driftlab {

/// `value` as text; an open or empty interval counts as none. Values below 1e-4 or from 1e7 on have an exponent.
[[nodiscard]] std::string significant(double value, std::optional<double> low = {}, std::optional<double> high = {});

}  // namespace driftlab
