#include "core/signal/guess_time.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 20;   ///< steps from which a rise says something
constexpr std::size_t kSeen = 10000;  ///< rows
constexpr double kLeastRate = 0.5;    ///< [Hz]
constexpr double kMostRate = 5e4;     ///< [Hz]
constexpr double kEvenShare = 0.9;    ///< of the steps of a time lie near their median
constexpr double kEvenWithin = 0.5;   ///< of the median

/// The median step of a column that rises evenly; nothing for another, and for a number of the row.
std::optional<double> even_step(std::span<const double> values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double step = values[i] - values[i - 1];
    if (!(step > 0.0) || !std::isfinite(step)) {
      return std::nullopt;
    }
    steps.push_back(step);
  }
  if (steps.size() < kFewest) {
    return std::nullopt;
  }
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  if (*least == 1.0 && *most == 1.0) {
    return std::nullopt;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double median = *middle;
  const auto near = std::count_if(steps.begin(), steps.end(),
                                  [&](double step) { return std::abs(step - median) <= kEvenWithin * median; });
  const bool even = static_cast<double>(near) >= kEvenShare * static_cast<double>(steps.size());
  return even ? std::optional<double>(median) : std::nullopt;
}

}  // namespace

std::optional<TimeGuess> guess_time(const ColumnNames& names, std::span<const std::optional<ColumnRole>> roles,
                                    const std::function<std::span<const double>(std::size_t)>& column) {
  const auto is_time = [](const std::optional<ColumnRole>& role) {
    return role && role->quantity == Quantity::Time && role->unit;
  };
  if (std::any_of(roles.begin(), roles.end(), is_time)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<ColumnRole>& role = roles[i];
    if (role && role->quantity != Quantity::Unspecified && role->quantity != Quantity::Time) {
      continue;
    }
    const std::span<const double> values = column(i);
    const auto step = even_step(values.first(std::min(kSeen, values.size())));
    for (const std::string_view symbol : {"s", "ms", "us", "ns"}) {
      const Unit unit = parse_unit(symbol).value_or(Unit{});
      const double rate_hz = step ? 1.0 / unit.to_si(*step) : 0.0;
      if (rate_hz >= kLeastRate && rate_hz <= kMostRate) {
        return TimeGuess{names[i], unit, rate_hz};
      }
    }
  }
  return std::nullopt;
}

}  // namespace driftlab
