#include "schema/json/calibrate_recordings.hpp"

#include "core/calibrate/still_intervals.hpp"
#include "schema/json/calibration.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace driftlab {
namespace {

/// The three accelerometer channels.
std::optional<std::array<const ChannelView*, 3>> accelerometer(const RecordingView& view) {
  std::array<const ChannelView*, 3> channels{};
  for (const ChannelView& channel : view.channels) {
    const std::size_t axis = std::string_view("xyz").find(channel.role.axis);
    if (channel.role.quantity == Quantity::SpecificForce && channel.role.axis.size() == 1 && axis < 3) {
      channels[axis] = &channel;
    }
  }
  const bool complete = std::find(channels.begin(), channels.end(), nullptr) == channels.end();
  return complete ? std::optional(channels) : std::nullopt;
}

}  // namespace

RecordingCalibrator::RecordingCalibrator(std::size_t recordings, const CalibrateOptions& options)
    : recordings_(recordings), options_(options) {}

Status RecordingCalibrator::add(const RecordingSpec& spec, const RecordingView& view) {
  const bool rests = recordings_ == 1 && spec.condition.kind != ConditionKind::SixPosition;
  return rests ? add_rests(view) : add_positions(spec, view, options_.gravity_m_s2, positions_);
}

Status RecordingCalibrator::add_rests(const RecordingView& view) {
  const auto channels = accelerometer(view);
  if (!channels) {
    return fail(ErrorCode::UnknownColumn,
                "The recording needs specific_force along x, y and z; say which columns these are.",
                {{"parameter", "columns"}});
  }
  const auto [first, count] = longest_shared_run(*channels);
  std::array<std::span<const double>, 3> triad;
  for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
    triad[axis] = (*channels)[axis]->rows(first, count);
  }
  auto rests = find_still_intervals(triad, 1.0 / view.window.time.dt_s);
  if (!rests) {
    return fail(std::move(rests.error()));
  }
  std::vector<Triple> readings;
  for (const StillInterval& rest : *rests) {
    auto mean = triad_mean({triad[0].subspan(rest.first, rest.count), triad[1].subspan(rest.first, rest.count),
                            triad[2].subspan(rest.first, rest.count)});
    if (mean) {
      readings.push_back(mean->mean);
    }
  }
  auto found = calibrate_multi_position(readings, options_.gravity_m_s2);
  if (!found) {
    return fail(std::move(found.error()));
  }
  const Unit unit = channels->front()->role.unit.value_or(Unit{});
  report_.document["accelerometer"] = to_json(*found, unit);
  report_.text = "accelerometer, from " + std::to_string(found->positions) + " positions at rest\n" + to_text(*found);
  return {};
}

Result<CalibrationReport> RecordingCalibrator::finish() {
  struct Sensor {
    const char* name;
    const char* unit;
    const std::vector<KnownPosition>& positions;
  };
  for (const Sensor& sensor : {Sensor{"accelerometer", "m/s^2", positions_.accelerometer},
                               Sensor{"gyroscope", "rad/s", positions_.gyroscope}}) {
    const bool moved = std::any_of(sensor.positions.begin(), sensor.positions.end(),
                                   [](const KnownPosition& position) { return length(position.truth) > 0.0; });
    if (!moved) {
      continue;
    }
    auto found = calibrate_six_positions(sensor.positions, {options_.misalignment});
    if (!found) {
      Error error = found.error();
      error.message = std::string("The ") + sensor.name + ": " + error.message;
      return fail(std::move(error));
    }
    report_.document[sensor.name] = to_json(*found, *parse_unit(sensor.unit));
    report_.text += std::string(sensor.name) + ", from " + std::to_string(sensor.positions.size()) + " positions\n" +
                    to_text(*found, sensor.unit);
  }
  if (report_.text.empty()) {
    return fail(ErrorCode::TooFewSamples,
                "None of the recordings is a position of a six-position test or a known rate.");
  }
  report_.document["notes"] = positions_.notes;
  for (const std::string& note : positions_.notes) {
    report_.text += note + "\n";
  }
  return std::move(report_);
}

}  // namespace driftlab
