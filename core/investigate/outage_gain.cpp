#include "core/investigate/outage_gain.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/given_model.hpp"
#include "core/process/model.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// 0 to 5 in the order of ImuSample; nothing for a column that is no axis of an inertial unit.
std::optional<std::size_t> imu_channel(const ColumnRole& role) {
  const auto axis = axis_index(role.axis);
  if (!axis) {
    return std::nullopt;
  }
  if (role.quantity == Quantity::AngularRate) {
    return axis;
  }
  return role.quantity == Quantity::SpecificForce ? std::optional(3 + *axis) : std::nullopt;
}

/// Adds a process whose values are within its bounds; a value of zero is no process.
bool add(Model& model, std::string_view name, std::vector<double> values) {
  auto process = make_process(name, std::move(values));
  if (!process) {
    return false;
  }
  model.push_back(*std::move(process));
  return true;
}

Model base_model(const ChannelModel& channel) {
  Model model;
  for (const GivenProcess& process : noise_processes(channel)) {
    add(model, process.process, process.parameters);
  }
  if (!channel.given && channel.drift != 0.0) {
    add(model, "linear_drift", {channel.drift});
  }
  return model;
}

/// One studied axis while findings are added to it.
struct Axis {
  std::size_t channel;  ///< of the unit
  Model model;
  double bias_sd;
};

/// False where a navigation simulation cannot hold the finding.
bool extend(const Evidence& found, Axis& axis, ImuHardware& hardware) {
  const std::string_view name = found.cause->name;
  std::vector<double> values;
  for (const FoundParameter& parameter : found.parameters) {
    values.push_back(parameter.estimate.value);
  }
  if (values.empty()) {
    return false;
  }
  const std::size_t c = axis.channel;
  if (name == "white_noise_level") {
    std::erase_if(axis.model, [](const Process& process) { return process.kind->name == "white_noise"; });
    return add(axis.model, "white_noise", {values[0]});
  }
  if (name == "gauss_markov" || name == "random_walk" || name == "flicker_noise" || name == "linear_drift" ||
      name == "quantization_noise") {
    return add(axis.model, name, values);
  }
  if (name == "periodic_disturbance") {
    return add(axis.model, "sinusoid", values);
  }
  if (name == "turn_on_bias") {
    axis.bias_sd = std::hypot(axis.bias_sd, values[0]);
  } else if (name == "scale_factor_error") {
    hardware.scale_factor[c] = values[0];
  } else if (name == "axis_misalignment" && c < 3) {
    const auto row = static_cast<Eigen::Index>(c);
    const auto other = static_cast<Eigen::Index>(found.shape);
    hardware.gyroscope_misalignment(row, other) = values[0];
  } else if (name == "saturation") {
    hardware.range[c] = values[0];
  } else if (name == "output_resolution") {
    hardware.quantization_step[c] = values[0];
  } else if (name == "band_limited_noise") {
    hardware.bandwidth_hz[c] = values[0];
  } else {
    return false;
  }
  return true;
}

bool acts_on(const Evidence& found, std::size_t group) {
  return found.group == group ||
         std::find(found.also_groups.begin(), found.also_groups.end(), group) != found.also_groups.end();
}

}  // namespace

SensorModels sensor_models(const Report& report, const std::vector<ChannelGroup>& groups,
                           const OutageScenario& scenario) {
  SensorModels models;
  for (const ChannelModel& channel : report.models) {
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [&](const ChannelGroup& candidate) { return candidate.column == channel.channel; });
    const auto number = group == groups.end() ? std::nullopt : imu_channel(group->role);
    if (!number || models.baseline.axes[*number]) {
      continue;
    }
    const double bias_sd = scenario.truth.axes[*number].bias_sd;
    Axis axis{*number, base_model(channel), bias_sd};
    models.baseline.axes[*number] = AxisModel{ModelSchedule::constant(axis.model), bias_sd};
    for (const Finding& finding : report.findings) {
      if (acts_on(finding.evidence, static_cast<std::size_t>(group - groups.begin())) &&
          !extend(finding.evidence, axis, models.extended.hardware)) {
        models.left_out.push_back(std::string(finding.evidence.cause->name) + " of " + channel.channel);
      }
    }
    models.extended.axes[*number] = AxisModel{ModelSchedule::constant(std::move(axis.model)), axis.bias_sd};
  }
  return models;
}

Result<std::optional<OutageGain>> outage_gain(const Report& report, const std::vector<ChannelGroup>& groups,
                                              unsigned threads, const RunControl& control) {
  const OutageScenario scenario = prediction_scenario();
  SensorModels models = sensor_models(report, groups, scenario);
  if (std::none_of(models.baseline.axes.begin(), models.baseline.axes.end(),
                   [](const auto& axis) { return axis.has_value(); })) {
    return std::optional<OutageGain>();
  }
  PredictionOptions options;
  options.threads = static_cast<int>(std::max(1U, threads));
  auto predicted = predict_outage_errors(models.baseline, models.extended, scenario, options, control);
  if (!predicted) {
    if (predicted.error().code == ErrorCode::Cancelled) {
      return fail(predicted.error());
    }
    return std::optional<OutageGain>();
  }
  OutageGain gain;
  gain.baseline_m = predicted->baseline_m;
  gain.extended_m = predicted->extended_m;
  gain.adopted_m = predicted->adopted_m;
  gain.left_out = std::move(models.left_out);
  for (std::string& process : predicted->left_out) {
    gain.left_out_of_filters.push_back(std::move(process));
  }
  return std::optional(std::move(gain));
}

}  // namespace driftlab::investigate
