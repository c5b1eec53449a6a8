#include "core/navigate/navigation_filter.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

Status check_settings(const FilterSettings& settings) {
  const auto bad = [](const char* member) {
    return fail(ErrorCode::InvalidArgument, "The filter's " + std::string(member) + " is not a possible value.",
                {{"parameter", member}});
  };
  const InitialUncertainty& initial = settings.initial;
  if (!(initial.position_sd_m.allFinite() && initial.position_sd_m.minCoeff() > 0.0 &&
        initial.velocity_sd_m_s.allFinite() && initial.velocity_sd_m_s.minCoeff() > 0.0)) {
    return bad("initial.position_sd_m or velocity_sd_m_s");
  }
  if (!(initial.tilt_sd_rad > 0.0 && initial.tilt_sd_rad < 4.0 && initial.heading_sd_rad > 0.0 &&
        initial.heading_sd_rad < 4.0)) {
    return bad("initial.tilt_sd_deg or heading_sd_deg");
  }
  if (settings.covariance_samples < 1 || settings.covariance_samples > 100) {
    return bad("covariance_samples");
  }
  if (settings.non_holonomic && !(settings.non_holonomic->rate_hz > 0.0 && settings.non_holonomic->sd_m_s > 0.0)) {
    return bad("non_holonomic");
  }
  for (const AxisModel& axis : settings.imu.axes) {
    if (!(axis.bias_sd >= 0.0 && std::isfinite(axis.bias_sd))) {
      return bad("bias_sd");
    }
  }
  return settings.lever_arm_m.allFinite() ? Status{} : bad("lever_arm_m");
}

}  // namespace

Status FilterDesign::check(const FilterSettings& settings, double dt_s) {
  FilterSettings first = settings;
  first.covariance_samples = std::clamp(settings.covariance_samples, 0, 1);  // one step length stands for all
  if (settings.covariance_samples > 100) {
    first.covariance_samples = settings.covariance_samples;  // refused
  }
  for (AxisModel& axis : first.imu.axes) {
    axis.processes = ModelSchedule::constant(axis.processes.model(0));
  }
  auto design = make(first, dt_s);
  return design ? Status{} : fail(design.error());
}

Result<FilterDesign> FilterDesign::make(const FilterSettings& settings, double dt_s) {
  if (auto status = check_settings(settings); !status) {
    return fail(status.error());
  }
  FilterDesign design;
  design.settings_ = settings;
  design.dt_s_ = dt_s;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const AxisModel& axis = settings.imu.axes[c];
    const std::size_t bands = c < 3 ? axis.processes.size() : 1;
    for (std::size_t band = 0; band < bands; ++band) {
      auto dynamics =
          make_channel_dynamics(axis.processes.model(band), axis.bias_sd, dt_s, settings.covariance_samples);
      if (!dynamics) {
        return fail(dynamics.error());
      }
      design.channels_[c].push_back(std::move(*dynamics));
    }
    design.first_[c] = design.sensor_states_;
    design.sensor_states_ += design.channels_[c].front().states;
  }
  for (const double sd : settings.constants_sd) {
    if (!(sd > 0.0 && std::isfinite(sd))) {
      return fail(ErrorCode::InvalidArgument, "The standard deviation of an estimated constant is above 0.",
                  {{"parameter", "constants_sd"}});
    }
  }
  if (!settings.constants_tau_s.empty() && settings.constants_tau_s.size() != settings.constants_sd.size()) {
    return fail(ErrorCode::InvalidArgument, "Every estimated constant has a correlation time, or none has.",
                {{"parameter", "constants_tau_s"}});
  }
  const auto white = make_process("white_noise", {1.0});
  if (!white) {
    return fail(white.error());
  }
  auto unit = make_channel_dynamics({*white}, 0.0, dt_s, settings.covariance_samples);
  if (!unit) {
    return fail(unit.error());
  }
  design.unit_white_ = std::move(*unit);
  design.sensor_states_ += static_cast<int>(settings.constants_sd.size());
  if (design.sensor_states_ > kMaxSensorStates) {
    return fail(ErrorCode::LimitExceeded, "The error models ask for more than 64 sensor states.",
                {{"limit", std::to_string(kMaxSensorStates)}});
  }
  return design;
}

}  // namespace driftlab
