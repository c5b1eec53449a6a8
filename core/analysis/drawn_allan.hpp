#pragma once
/// What a figure of a stored result draws: the Allan deviation of a channel beside its best model, in the unit drawn.
#include "core/analysis/stored_channel.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// A process of the model by itself.
struct DrawnComponent {
  std::string process;  ///< registry name
  DrawnCurve deviation;
};

/// What the best fit implies.
struct DrawnModel {
  DrawnCurve whole;        ///< on a grid of its own
  DrawnCurve at_measured;  ///< at the times that were measured
  std::vector<DrawnComponent> components;
};

/// The level of a process where it is read off the curve of that process (`level_place`).
struct DrawnLevel {
  std::size_t component = 0;
  std::string name;  ///< `N`, `K`
  ReportedValue value;
  LevelPlace place;
};

/// The bias instability as a line at its floor (`bias_floor`).
struct DrawnBias {
  ReportedValue value;
  double deviation = 0.0;  ///< in the unit drawn
};

struct DrawnAllan {
  DrawnUnit unit;
  DrawnCurve classical;
  std::optional<DrawnCurve> robust;  ///< where it is worth drawing (`robust_differs`)
  std::optional<DrawnModel> model;   ///< nothing where the best fit implies no curve
  std::vector<DrawnLevel> levels;    ///< of a model of several processes
  std::optional<DrawnBias> bias;     ///< of angular rates and specific forces
};

/// O(times x processes).
[[nodiscard]] DrawnAllan drawn_allan(const StoredChannel& channel);

/// Measured over model.
struct DrawnRatios {
  DrawnCurve classical;
  std::optional<DrawnCurve> robust;
  double end = 1.0;  ///< factor from 1 to the end of their axis
};

/// Precondition: there is a model.
[[nodiscard]] DrawnRatios ratios_of(const DrawnAllan& drawn);

}  // namespace driftlab
