#include "core/signal/measured_temperature.hpp"

#include "core/signal/recording_columns.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kMostRows = 65536;
constexpr double kFreezing = 273.15;  // [K]

double quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

std::optional<MeasuredTemperature> measured_temperature(
    const RecordingSpec& spec, const ColumnNames& names, const RecordingView& view,
    const std::function<std::span<const double>(std::size_t)>& column) {
  const auto columns = RecordingColumns::read(spec, names, column);
  const auto index = columns ? columns->find(Quantity::Temperature) : std::nullopt;
  if (!index) {
    return std::nullopt;
  }
  const Unit unit = columns->unit(*index);
  if (unit.dimension != Dimension::Temperature) {
    return std::nullopt;
  }
  const std::span<const double> all = view.distinct.empty() ? columns->samples(*index) : view.distinct[*index];
  const std::size_t end = std::min(all.size(), view.window.first + view.window.count);
  std::vector<double> values;
  const std::size_t step = std::max<std::size_t>(1, view.window.count / kMostRows);
  for (std::size_t row = view.window.first; row < end; row += step) {
    if (const double kelvin = unit.to_si(all[row]); std::isfinite(kelvin)) {
      values.push_back(kelvin - kFreezing);
    }
  }
  if (values.empty()) {
    return std::nullopt;
  }
  return MeasuredTemperature{names[*index], quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95)};
}

}  // namespace driftlab
