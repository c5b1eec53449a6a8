#include "core/campaign/regression/scale_check.hpp"

#include "core/campaign/regression/session_means.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::regression {
namespace {

constexpr double kPerMillion = 1e6;

/// What the axis of a sensor truly saw under a condition [SI]; nothing where the condition does not say.
std::optional<double> truth_of(const Condition& condition, Dimension sensor, const std::string& axis) {
  const bool along = condition.axis == axis;
  if (sensor == Dimension::AngularRate) {
    if (condition.kind == ConditionKind::Static || condition.kind == ConditionKind::SixPosition) {
      return 0.0;
    }
    return condition.kind == ConditionKind::ConstantRate && along ? condition.value : std::nullopt;
  }
  if (sensor == Dimension::SpecificForce && condition.kind == ConditionKind::SixPosition && along && condition.up) {
    return *condition.up ? kStandardGravity : -kStandardGravity;
  }
  return std::nullopt;
}

/// Sums of a line through points (true value, mean), each with a weight.
struct Line {
  double weight = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double largest = 0.0;  ///< of |true value|
  bool gyroscope = false;

  void add(double truth, double mean, double samples) {
    weight += samples;
    x += samples * truth;
    y += samples * mean;
    xx += samples * truth * truth;
    xy += samples * truth * mean;
    largest = std::max(largest, std::abs(truth));
  }
  /// Nothing where all true values are one.
  [[nodiscard]] std::optional<double> slope() const {
    const double spread = xx - x * x / weight;
    constexpr double kOneValue = 1e-9;
    return spread > kOneValue * weight * largest * largest ? std::optional((xy - x * y / weight) / spread)
                                                           : std::nullopt;
  }
};

std::map<std::string, SessionFigure> scale_factors_of(const PowerUp& session) {
  std::map<std::string, Line> lines;
  for (const ComparedRecording* recording : session.recordings) {
    const auto condition = parse_condition(recording->condition);
    for (const ComparedChannel& channel : recording->channels) {
      const driftlab::Unit unit = channel.result.parsed_unit();
      const auto truth = condition ? truth_of(*condition, unit.dimension, channel.result.axis) : std::nullopt;
      if (!truth || !channel.facts.mean || channel.result.samples == 0) {
        continue;
      }
      const bool gyroscope = unit.dimension == Dimension::AngularRate;
      const double mean = unit.to_si(*channel.facts.mean) + (channel.facts.mean_of_error ? *truth : 0.0);
      Line& line = lines[std::string(gyroscope ? "gyroscope " : "accelerometer ") + channel.result.axis];
      line.add(*truth, mean, static_cast<double>(channel.result.samples));
      line.gyroscope = gyroscope;
    }
  }
  std::map<std::string, SessionFigure> found;
  for (const auto& [name, line] : lines) {
    if (const auto slope = line.slope()) {
      found.emplace(name, SessionFigure{*slope - 1.0, line.gyroscope});
    }
  }
  return found;
}

}  // namespace

EventCheck check_scale_factor(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                              const ScaleMargins& margins, double level) {
  const ShiftWords words{
      .check = "scale_factor",
      .figure = "scale factor",
      .without =
          "no session of both arms has recordings of one axis under two known inputs (static and "
          "constant_rate, or six_position up and down)",
      .text = [](double value, bool /*gyroscope*/) { return significant(kPerMillion * value) + " ppm"; }};
  return check_shift(arm_figures(baseline, candidate, scale_factors_of), candidate,
                     {margins.gyroscope, margins.accelerometer}, words, level);
}

}  // namespace driftlab::regression
