#include "core/analysis/drawn_allan.hpp"

#include <utility>

namespace driftlab {
namespace {

constexpr double kLeastRatio = 0.25;    ///< |ln ratio| that the axis holds however close the model is
constexpr double kBeyondRatios = 1.25;  ///< widening of the axis
constexpr double kMostRatio = 8.0;

DrawnCurve curve_of(const std::vector<double>& x, const std::vector<double>& y, double factor) {
  return scaled(DrawnCurve{x, Values(y.begin(), y.end()), {}, {}}, factor);
}

DrawnModel drawn(const ImpliedBeside& implied, double factor) {
  const ImpliedCurves& curves = implied.curves;
  DrawnModel model{curve_of(curves.tau_s, curves.deviation, factor),
                   curve_of(implied.at_measured.tau_s, implied.at_measured.deviation, factor),
                   {}};
  for (const ImpliedComponent& component : curves.components) {
    model.components.push_back({component.process, curve_of(curves.tau_s, component.deviation, factor)});
  }
  return model;
}

std::optional<DrawnCurve> robust_of(const StoredChannel& channel, double factor) {
  if (!channel.contamination || !robust_differs(*channel.contamination) || channel.robust.y.empty()) {
    return std::nullopt;
  }
  return deviations_of_wavelets(channel.told.haar.scale, channel.told.dt_s, factor, channel.robust);
}

/// The levels of the processes that are drawn, each where its curve equals it.
std::vector<DrawnLevel> levels_of(const ReportedFit& fit, const DrawnModel& model,
                                  const std::vector<double>& measured_tau_s) {
  std::vector<DrawnLevel> levels;
  const std::vector<ReportedProcess> present = present_processes(fit);
  for (std::size_t i = 0; i < present.size() && i < model.components.size(); ++i) {
    const auto place = level_place(present[i].process, model.components[i].deviation, measured_tau_s);
    if (place && !present[i].parameters.empty() && present[i].parameters.front().second.value) {
      const auto& [name, value] = present[i].parameters.front();
      levels.push_back({i, name, value, *place});
    }
  }
  return levels;
}

std::optional<DrawnBias> bias_of(const StoredChannel& channel, const DrawnUnit& drawn) {
  const auto unit = parse_unit(channel.told.unit);
  if (!unit || unit->dimension == Dimension::One) {
    return std::nullopt;
  }
  for (const auto& [name, told] : channel.told.allan) {
    if (name == "B" && told.value) {
      return DrawnBias{told, bias_floor(*told.value, *unit, drawn)};
    }
  }
  return std::nullopt;
}

}  // namespace

DrawnAllan drawn_allan(const StoredChannel& channel) {
  DrawnAllan allan;
  allan.unit = drawn_unit(channel.told.unit);
  allan.classical =
      scaled(DrawnCurve{channel.allan.tau_s, channel.allan.deviation, channel.allan.low, channel.allan.high},
             allan.unit.factor);
  allan.robust = robust_of(channel, allan.unit.factor);
  allan.bias = bias_of(channel, allan.unit);
  const ReportedFit* const fit = channel.best_fit();
  if (const auto implied = fit != nullptr ? implied_by(*fit, channel) : std::nullopt) {
    allan.model = drawn(*implied, allan.unit.factor);
    if (allan.model->components.size() > 1) {
      allan.levels = levels_of(*fit, *allan.model, allan.classical.x);
    }
  }
  return allan;
}

DrawnRatios ratios_of(const DrawnAllan& drawn) {
  const auto relative = [&](const DrawnCurve& curve) {
    return relative_to(curve, drawn.model->at_measured, drawn.model->whole);
  };
  DrawnRatios ratios{relative(drawn.classical), std::nullopt, 1.0};
  ratios.end = end_of_ratios(farthest_log(ratios.classical.y, kLeastRatio), kBeyondRatios, kMostRatio);
  if (drawn.robust) {
    ratios.robust = relative(*drawn.robust);
  }
  return ratios;
}

}  // namespace driftlab
