#include "core/investigate/report/outage_gain.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/process/linear_drift.hpp"
#include "core/process/registry.hpp"

#include <algorithm>

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

Model base_model(const ChannelModel& channel, const ChannelBase& base) {
  Model model = noise_processes(channel, base);
  if (!channel.given && base.drift != 0.0) {
    model.push_back({&registered<LinearDrift>(), {base.drift}});
  }
  return model;
}

/// False where a navigation simulation cannot hold the finding.
bool extend(const Evidence& found, UnitAxis& axis) {
  const Cause& cause = *found.cause;
  if (found.parameters.empty()) {
    return false;
  }
  return cause.in_unit != nullptr ? cause.in_unit(found, axis)
                                  : !cause.process.empty() && add_process(axis, cause.process, found);
}

/// What was found of the axis, as properties of the unit.
void set_properties(const UnitAxis& axis, ImuHardware& hardware) {
  const std::size_t c = axis.channel;
  hardware.scale_factor[c] = axis.scale_factor.value_or(hardware.scale_factor[c]);
  hardware.range[c] = axis.range.value_or(hardware.range[c]);
  hardware.quantization_step[c] = axis.quantization_step.value_or(hardware.quantization_step[c]);
  hardware.bandwidth_hz[c] = axis.bandwidth_hz.value_or(hardware.bandwidth_hz[c]);
  for (std::size_t other = 0; c < 3 && other < axis.misalignment.size(); ++other) {
    double& element = hardware.gyroscope_misalignment(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(other));
    element = axis.misalignment.at(other).value_or(element);
  }
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
    UnitAxis axis{.channel = *number, .model = base_model(channel, channel.beside), .bias_sd = bias_sd};
    models.baseline.axes[*number] = AxisModel{ModelSchedule::constant(base_model(channel, channel.alone)), bias_sd};
    for (const Finding& finding : report.findings) {
      if (acts_on(finding.evidence, static_cast<std::size_t>(group - groups.begin())) &&
          !extend(finding.evidence, axis)) {
        models.left_out.push_back(std::string(finding.evidence.cause->name) + " of " + channel.channel);
      }
    }
    set_properties(axis, models.extended.hardware);
    models.extended.axes[*number] = AxisModel{ModelSchedule::constant(std::move(axis.model)), axis.bias_sd};
  }
  return models;
}

Result<std::optional<OutageGain>> outage_gain(const Report& report, const std::vector<ChannelGroup>& groups,
                                              const RunControl& control) {
  const OutageScenario scenario = prediction_scenario();
  SensorModels models = sensor_models(report, groups, scenario);
  if (std::none_of(models.baseline.axes.begin(), models.baseline.axes.end(),
                   [](const auto& axis) { return axis.has_value(); })) {
    return std::optional<OutageGain>();
  }
  auto predicted = predict_outage_errors(models.baseline, models.extended, scenario, {}, control);
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
