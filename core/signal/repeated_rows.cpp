#include "core/signal/repeated_rows.hpp"

#include "core/signal/missing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace driftlab {
namespace {

/// The same number, or missing for the same reason.
bool same_cell(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b) && why_missing(a).why == why_missing(b).why);
}

}  // namespace

std::vector<std::size_t> repeated_rows(std::span<const double> stamps, std::size_t columns,
                                       const std::function<std::span<const double>(std::size_t)>& column) {
  if (std::adjacent_find(stamps.begin(), stamps.end()) == stamps.end()) {
    return {};
  }
  std::vector<std::uint8_t> same(stamps.size(), 1);
  for (std::size_t c = 0; c < columns; ++c) {
    const std::span<const double> values = column(c);
    if (values.data() == stamps.data()) {
      continue;
    }
    for (std::size_t i = 1; i < values.size(); ++i) {
      same[i] = same[i] != 0 && same_cell(values[i], values[i - 1]) ? 1 : 0;
    }
  }
  std::vector<std::size_t> rows;
  double standing = 0.0;
  double moving = 0.0;
  double moving_same = 0.0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] != stamps[i - 1]) {
      moving += 1.0;
      moving_same += same[i];
    } else {
      standing += 1.0;
      if (same[i] != 0) {
        rows.push_back(i);
      }
    }
  }
  const double share = static_cast<double>(rows.size()) / standing;
  if (share < 0.5 || 2.0 * moving_same > share * moving) {
    rows.clear();
  }
  return rows;
}

}  // namespace driftlab
