#include "core/calibrate/known_positions.hpp"

#include "core/signal/recording_columns.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// The mean of a triad in SI.
Result<TriadMean> mean_of(const Triad& triad) {
  const auto [first, count] = longest_shared_run(triad);
  if (count == 0) {
    return fail(ErrorCode::TooFewSamples, "The three axes of a triad share no sound samples.");
  }
  std::array<std::span<const double>, 3> values;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    values[axis] = triad[axis]->rows(first, count);
  }
  auto mean = triad_mean(values);
  for (std::size_t axis = 0; axis < 3 && mean; ++axis) {
    const Unit unit = triad[axis]->role.unit.value_or(Unit{});
    mean->mean[axis] = unit.to_si(mean->mean[axis]);
    mean->sigma[axis] *= unit.factor;
  }
  return mean;
}

/// What a condition makes a sensor read, if it says so.
std::optional<Triple> truth_of(const Condition& condition, Quantity quantity, double gravity_m_s2) {
  const auto axis = axis_index(condition.axis);
  Triple truth{};
  if (quantity == Quantity::SpecificForce && condition.kind == ConditionKind::SixPosition && axis && condition.up) {
    truth[*axis] = *condition.up ? gravity_m_s2 : -gravity_m_s2;
    return truth;
  }
  if (quantity == Quantity::AngularRate && condition.kind == ConditionKind::ConstantRate && axis && condition.value) {
    truth[*axis] = *condition.value;
    return truth;
  }
  if (quantity == Quantity::AngularRate &&
      (condition.kind == ConditionKind::Static || condition.kind == ConditionKind::SixPosition)) {
    return truth;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Triad> triad_of(const RecordingView& view, Quantity quantity) {
  Triad triad{};
  for (const ChannelView& channel : view.channels) {
    const auto axis = axis_index(channel.role.axis);
    if (channel.role.quantity == quantity && axis) {
      triad[*axis] = &channel;
    }
  }
  const bool complete =
      std::all_of(triad.begin(), triad.end(), [](const ChannelView* channel) { return channel != nullptr; });
  return complete ? std::optional(triad) : std::nullopt;
}

Status add_positions(const RecordingSpec& spec, const RecordingView& view, double gravity_m_s2,
                     KnownPositions& positions) {
  if (!(gravity_m_s2 > 0.0 && std::isfinite(gravity_m_s2))) {
    return fail(ErrorCode::InvalidArgument, "Gravity must be a positive number of m/s^2.", {{"parameter", "gravity"}});
  }
  bool used = false;
  for (const Quantity quantity : {Quantity::SpecificForce, Quantity::AngularRate}) {
    const auto truth = truth_of(spec.condition, quantity, gravity_m_s2);
    const auto triad = triad_of(view, quantity);
    if (!truth || !triad) {
      continue;
    }
    auto mean = mean_of(*triad);
    if (!mean) {
      return fail(mean.error());
    }
    auto& list = quantity == Quantity::SpecificForce ? positions.accelerometer : positions.gyroscope;
    list.push_back({*mean, *truth});
    used = true;
  }
  if (!used) {
    positions.notes.push_back("'" + spec.id +
                              "' gives no position: it needs three axes and the condition six_position, "
                              "constant_rate or static.");
  }
  return {};
}

}  // namespace driftlab
