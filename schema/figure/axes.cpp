#include "schema/figure/axes.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::figure {

Axis ratio_axis(std::string name, double limit) {
  return {ScaleKind::Log, std::move(name), std::pair{1.0 / limit, limit}};
}

Axis places_axis(std::string name, std::size_t count) {
  Axis axis{ScaleKind::Linear, std::move(name), std::pair{0.4, static_cast<double>(count) + 0.6}};
  for (std::size_t i = 1; i <= count; ++i) {
    axis.ticks.push_back(static_cast<double>(i));
  }
  return axis;
}

double beside(double place, std::size_t index, std::size_t count) {
  const auto members = static_cast<double>(std::max<std::size_t>(1, count));
  return place + (static_cast<double>(index) / members - 0.5 + 0.5 / members) * 0.5;
}

Axis axis_about_zero(std::string name, double greatest) {
  const double far = std::max(1e-9, greatest);
  return {ScaleKind::Linear, std::move(name), std::pair{-far * 0.04, far * 1.06}};
}

Axis axis_from_zero(std::string name, double greatest) {
  return {ScaleKind::Linear, std::move(name), std::pair{0.0, greatest * 1.12}};
}

}  // namespace driftlab::figure
