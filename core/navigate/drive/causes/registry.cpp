#include "core/navigate/drive/causes/cause.hpp"

#include <algorithm>
#include <cassert>

/// The causes, one line each, named after the function of their file, in the order in which they are sought.
#define DRIFTLAB_DRIVE_CAUSES(CAUSE)      \
  CAUSE(sample_clock)                     \
  CAUSE(imu_time_offset)                  \
  CAUSE(gnss_velocity_latency)            \
  CAUSE(gnss_velocity_averaging)          \
  CAUSE(gnss_lever_arm)                   \
  CAUSE(gyro_scale_factor_error)          \
  CAUSE(gyro_axis_misalignment)           \
  CAUSE(accelerometer_scale_factor_error) \
  CAUSE(mounting_angles)                  \
  CAUSE(odometer_scale)                   \
  CAUSE(wheel_slip)                       \
  CAUSE(initial_heading)                  \
  CAUSE(gnss_coloured_noise)              \
  CAUSE(vibration_noise)                  \
  CAUSE(noise_level)

namespace driftlab::drive {

#define DRIFTLAB_DECLARE_CAUSE(name) Cause name();
DRIFTLAB_DRIVE_CAUSES(DRIFTLAB_DECLARE_CAUSE)
#undef DRIFTLAB_DECLARE_CAUSE

const std::vector<Cause>& cause_registry() {
#define DRIFTLAB_ENTER_CAUSE(name) name(),
  static const std::vector<Cause> all_causes{DRIFTLAB_DRIVE_CAUSES(DRIFTLAB_ENTER_CAUSE)};
#undef DRIFTLAB_ENTER_CAUSE
  return all_causes;
}

const Cause* find_cause(std::string_view name) {
  const auto& all = cause_registry();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Cause& cause) { return cause.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const std::vector<Knob>& all_knobs() {
  static const std::vector<Knob> knobs = [] {
    std::vector<Knob> list;
    for (const Cause& cause : cause_registry()) {
      for (Knob knob : cause.knobs) {
        knob.cause = cause.name;
        list.push_back(knob);
      }
    }
    return list;
  }();
  return knobs;
}

const Knob* find_knob(std::string_view cause, std::string_view parameter) {
  for (const Knob& knob : all_knobs()) {
    if (knob.cause == cause && knob.parameter == parameter) {
      return &knob;
    }
  }
  return nullptr;
}

std::vector<EstimatedConstant> declared_states(const Document& document, const FilterOptions& options) {
  std::vector<EstimatedConstant> states;
  for (const Knob& knob : all_knobs()) {
    if (const double sd = knob.prior_sd != nullptr ? knob.prior_sd(document, options) : 0.0; sd > 0.0) {
      states.push_back({knob.turn, sd});
    }
  }
  return states;
}

std::string_view words_of(std::string_view cause) {
  const Cause* const found = find_cause(cause);
  assert(found != nullptr);
  return found->words;
}

std::string words_of(const Knob& knob) {
  const std::string_view parameter = knob.parameter.substr(0, knob.parameter.find('_'));
  const bool several = find_cause(knob.cause)->knobs.size() > 1;
  return std::string(words_of(knob.cause)) + (several ? " (" + std::string(parameter) + ")" : "");
}

DriveFinding finding_of(const Knob& knob) {
  DriveFinding finding;
  finding.cause = knob.cause;
  finding.parameter = knob.parameter;
  finding.title = knob.title;
  finding.unit = knob.unit;
  finding.told_apart = knob.told_apart;
  finding.evidence = "innovations";
  return finding;
}

}  // namespace driftlab::drive
