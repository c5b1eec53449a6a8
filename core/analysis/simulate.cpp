#include "core/analysis/simulate.hpp"

#include "core/investigate/search/simulate_channel.hpp"
#include "core/process/published_models.hpp"
#include "core/signal/recording_columns.hpp"

#include <algorithm>

namespace driftlab {
namespace {

using investigate::Baseline;

std::size_t samples_of(const AxisSimulation& wanted) {
  return static_cast<std::size_t>(wanted.duration_s * wanted.rate_hz);
}

Result<std::string> column_of(const Baseline& model, const std::string& wanted) {
  if (wanted.empty()) {
    if (!model.by_channel.empty()) {
      return model.by_channel.begin()->first;
    }
    return std::string(model.quantity == Quantity::SpecificForce ? "fz" : "gz");
  }
  if (!model.by_channel.empty() && model.by_channel.count(wanted) == 0) {
    return fail(ErrorCode::NotFound, "The model has no channel '" + wanted + "'.", {{"parameter", "--channel"}});
  }
  return wanted;
}

/// A recording that moves as wanted and has read nothing yet, which it has from `blank`.
Result<investigate::StudyRecording> blank_recording(const AxisSimulation& wanted, const std::string& column,
                                                    const ColumnRole& role, std::vector<double>& blank) {
  RecordingSpec spec;
  spec.id = "simulated";
  spec.rate_hz = wanted.rate_hz;
  spec.condition = wanted.condition;
  spec.columns[column] = role;
  blank.assign(samples_of(wanted), 0.0);
  return investigate::make_study_recording(spec, {column}, blank.size(),
                                           [&](std::size_t) { return std::span<const double>(blank); });
}

}  // namespace

Result<SampleTable> simulate_preset(const std::string& preset, const AxisSimulation& wanted) {
  auto model = published_model(preset, wanted.condition);
  if (!model) {
    return fail(model.error());
  }
  const double dt_s = 1.0 / wanted.rate_hz;
  Random random(wanted.seed);
  SampleTable table{{"gz [deg/s]"}, {6}, simulate(*model, random, dt_s, samples_of(wanted))};
  const Unit unit = *parse_unit("deg/s");
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    table.values[i] = unit.from_si(stated_rate(wanted.condition, wanted.condition.axis, static_cast<double>(i) * dt_s) +
                                   table.values[i]);
  }
  return table;
}

Result<ChannelSimulation> simulate_model(const Baseline& model, const std::string& channel,
                                         const AxisSimulation& wanted) {
  const auto column = column_of(model, channel);
  if (!column) {
    return fail(column.error());
  }
  const bool gyro = model.quantity != Quantity::SpecificForce;
  const Unit unit = *parse_unit(gyro ? "deg/s" : "m/s^2");
  const std::string last = column->substr(column->size() - 1);
  const ColumnRole role{gyro ? Quantity::AngularRate : Quantity::SpecificForce, axis_index(last) ? last : "z", unit};
  std::vector<double> blank;
  auto recording = blank_recording(wanted, *column, role, blank);
  if (!recording) {
    return fail(recording.error());
  }
  auto made = investigate::simulate_channel(model, *std::move(recording), *column, role, wanted.seed);
  ChannelSimulation result;
  result.left_out = std::move(made.left_out);
  result.table.columns = {"t [s]", *column + " [" + std::string(unit.symbol) + "]"};
  result.table.decimals = {6, 9};
  std::optional<double> before;
  for (std::size_t i = 0; i < made.reading.size(); ++i) {
    if (!made.present.empty() && made.present[i] == 0) {
      continue;
    }
    const double error_s = made.stamp_error_s.empty() ? 0.0 : made.stamp_error_s[i];
    const double stamp_s = static_cast<double>(i) / wanted.rate_hz + error_s;
    before = before ? std::max(*before, stamp_s) : stamp_s;  // a recorder never writes a stamp before the last one
    result.table.values.push_back(*before);
    result.table.values.push_back(unit.from_si(made.reading[i]));
  }
  return result;
}

}  // namespace driftlab
