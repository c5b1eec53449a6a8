#include "core/analysis/drawn_values.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr double kSamePlace = 1e-9;    ///< relative
constexpr double kFloorOverB = 0.664;  ///< sqrt(2 ln 2/pi)

Values roots(Values values, double factor) {
  for (auto& value : values) {
    value = value && *value >= 0.0 ? std::optional(std::sqrt(*value) * factor) : std::nullopt;
  }
  return values;
}

}  // namespace

Values scaled(Values values, double factor) {
  for (auto& value : values) {
    value = value ? std::optional(*value * factor) : std::nullopt;
  }
  return values;
}

DrawnCurve scaled(DrawnCurve curve, double factor) {
  curve.y = scaled(std::move(curve.y), factor);
  curve.low = scaled(std::move(curve.low), factor);
  curve.high = scaled(std::move(curve.high), factor);
  return curve;
}

Values over(const Values& values, const Values& base) {
  Values ratio;
  for (std::size_t i = 0; i < values.size() && i < base.size(); ++i) {
    const auto& value = values[i];
    const auto& unit = base[i];
    ratio.push_back(value && unit && *unit > 0.0 ? std::optional(*value / *unit) : std::nullopt);
  }
  return ratio;
}

DrawnUnit drawn_unit(const std::string& channel_unit) {
  const auto unit = parse_unit(channel_unit);
  if (!unit || (unit->dimension != Dimension::AngularRate && unit->dimension != Dimension::SpecificForce)) {
    return {channel_unit, 1.0};
  }
  const auto wanted = parse_unit(unit->dimension == Dimension::AngularRate ? "deg/h" : "mg");
  return {wanted->symbol, unit->factor / wanted->factor};
}

DrawnCurve deviations_of_wavelets(std::span<const std::size_t> scale, double dt_s, double factor,
                                  const DrawnCurve& variances) {
  DrawnCurve curve;
  for (const std::size_t samples : scale) {
    curve.x.push_back(static_cast<double>(samples) / 2.0 * dt_s);
  }
  const double root_two = factor * std::sqrt(2.0);
  curve.y = roots(variances.y, root_two);
  curve.low = roots(variances.low, root_two);
  curve.high = roots(variances.high, root_two);
  return curve;
}

std::optional<double> read_at(const DrawnCurve& curve, double x) {
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const std::optional<double> here = curve.y[i];
    if (curve.x[i] < x * (1.0 - kSamePlace) || !here) {
      continue;
    }
    if (std::abs(curve.x[i] - x) <= kSamePlace * x) {
      return here;
    }
    const std::optional<double> before = i > 0 ? curve.y[i - 1] : std::nullopt;
    if (!before) {
      return std::nullopt;
    }
    const double share = std::log(x / curve.x[i - 1]) / std::log(curve.x[i] / curve.x[i - 1]);
    return std::exp(std::log(*before) + std::log(*here / *before) * share);
  }
  return std::nullopt;
}

DrawnCurve relative_to(const DrawnCurve& curve, const DrawnCurve& exact, const DrawnCurve& model) {
  Values base;
  for (const double x : curve.x) {
    const auto found = std::find(exact.x.begin(), exact.x.end(), x);
    const std::optional<double> known =
        found != exact.x.end() ? exact.y[static_cast<std::size_t>(found - exact.x.begin())] : std::nullopt;
    base.push_back(known ? known : read_at(model, x));
  }
  return {curve.x, over(curve.y, base), over(curve.low, base), over(curve.high, base)};
}

double bias_floor(double bias, const Unit& channel, const DrawnUnit& drawn) {
  return bias / lab_unit(channel.dimension, 0).per_si / channel.factor * drawn.factor * kFloorOverB;
}

std::optional<LevelPlace> level_place(std::string_view process, const DrawnCurve& curve,
                                      std::span<const double> measured_tau_s) {
  const double tau_s = process == "white_noise" ? 1.0 : process == "random_walk" ? 3.0 : 0.0;
  if (tau_s == 0.0 || tau_s < measured_tau_s.front() || tau_s > measured_tau_s.back()) {
    return std::nullopt;
  }
  const auto deviation = read_at(curve, tau_s);
  return deviation ? std::optional(LevelPlace{tau_s, *deviation}) : std::nullopt;
}

bool robust_differs(const Contamination& contamination) {
  return !contamination.disjoint_scales.empty() || contamination.verdict == "contaminated";
}

double farthest_log(const Values& ratios, double least) {
  for (const auto& ratio : ratios) {
    least = ratio && *ratio > 0.0 ? std::max(least, std::abs(std::log(*ratio))) : least;
  }
  return least;
}

double end_of_ratios(double farthest, double widening, double most) {
  return std::min(std::exp(farthest * widening), most);
}

double reach_of_ratios(const Values& ratios, double margin, double least) {
  for (const auto& ratio : ratios) {
    least = ratio && *ratio > 0.0 ? std::max({least, *ratio * margin, margin / *ratio}) : least;
  }
  return least;
}

double size_of_dynamics(const std::optional<double>& value) { return value ? std::abs(*value) : 0.0; }

}  // namespace driftlab
