#include "core/investigate/causes/cause.hpp"

#include <cmath>

/// The causes, one line each, named after the function of their file, in the order in which the search takes them.
#define DRIFTLAB_CAUSES(CAUSE)        \
  CAUSE(white_noise_level)            \
  CAUSE(gauss_markov)                 \
  CAUSE(random_walk)                  \
  CAUSE(linear_drift)                 \
  CAUSE(flicker_noise)                \
  CAUSE(random_telegraph_noise)       \
  CAUSE(quantization_noise)           \
  CAUSE(output_resolution)            \
  CAUSE(periodic_disturbance)         \
  CAUSE(chirped_disturbance)          \
  CAUSE(modulated_disturbance)        \
  CAUSE(vibration_bursts)             \
  CAUSE(band_limited_noise)           \
  CAUSE(resonance)                    \
  CAUSE(heavy_tailed_noise)           \
  CAUSE(noise_level_change)           \
  CAUSE(common_mode_noise)            \
  CAUSE(outliers)                     \
  CAUSE(bias_step)                    \
  CAUSE(turn_on_bias)                 \
  CAUSE(heading_dependent_bias)       \
  CAUSE(warm_up_transient)            \
  CAUSE(temperature_bias)             \
  CAUSE(stuck_samples)                \
  CAUSE(missing_samples)              \
  CAUSE(timestamp_jitter)             \
  CAUSE(saturation)                   \
  CAUSE(rate_dependent_noise)         \
  CAUSE(acceleration_dependent_noise) \
  CAUSE(scale_factor_error)           \
  CAUSE(scale_factor_asymmetry)       \
  CAUSE(scale_factor_nonlinearity)    \
  CAUSE(axis_misalignment)            \
  CAUSE(reference_time_offset)        \
  CAUSE(reference_clock_drift)        \
  CAUSE(once_per_revolution)          \
  CAUSE(g_sensitivity)                \
  CAUSE(vibration_rectification)      \
  CAUSE(lever_arm)                    \
  CAUSE(bursty_clock)                 \
  CAUSE(duplicated_blocks)            \
  CAUSE(interpolated_samples)         \
  CAUSE(averaged_samples)             \
  CAUSE(unit_error)                   \
  CAUSE(turned_sign)                  \
  CAUSE(swapped_axes)                 \
  CAUSE(reference_noise)              \
  CAUSE(clock_jump)                   \
  CAUSE(sampling_rate_change)

namespace driftlab::investigate {

#define DRIFTLAB_DECLARE_CAUSE(name) Cause name();
DRIFTLAB_CAUSES(DRIFTLAB_DECLARE_CAUSE)
#undef DRIFTLAB_DECLARE_CAUSE

const std::vector<Cause>& cause_registry() {
#define DRIFTLAB_ENTER_CAUSE(name) name(),
  static const std::vector<Cause> all_causes{DRIFTLAB_CAUSES(DRIFTLAB_ENTER_CAUSE)};
#undef DRIFTLAB_ENTER_CAUSE
  return all_causes;
}

const Cause* find_cause(std::string_view name) {
  for (const Cause& cause : cause_registry()) {
    if (cause.name == name) {
      return &cause;
    }
  }
  return nullptr;
}

const Cause* cause_of_process(std::string_view process) {
  for (const Cause& cause : cause_registry()) {
    if (!process.empty() && cause.process == process) {
      return &cause;
    }
  }
  return nullptr;
}

Concern concern_of(const Cause& cause) {
  if (cause.concern) {
    return *cause.concern;
  }
  if (const FileFact* const fact = cause.as<FileFact>()) {
    return fact->gives_lattice_step ? Concern::Format : Concern::Recording;
  }
  if (cause.as<RecordingFault>() != nullptr) {
    return Concern::Recording;
  }
  return cause.as<MeanEffect>() != nullptr ? Concern::Calibration : Concern::Noise;
}

Examine examine_of(const Cause& cause) {
  return std::visit(
      [](const auto& family) -> Examine {
        if constexpr (requires { family.examine; }) {
          return family.examine;
        } else {
          return nullptr;
        }
      },
      cause.family);
}

const CauseParameter& amplitude_of(const Cause& cause, double shape) {
  std::size_t nearest = 0;
  const MeanEffect* const mean = cause.as<MeanEffect>();
  for (std::size_t k = 1; mean != nullptr && k < mean->shape_of_parameter.size(); ++k) {
    const auto distance = [&](std::size_t j) { return std::fabs(mean->shape_of_parameter[j] - shape); };
    nearest = distance(k) < distance(nearest) ? k : nearest;
  }
  return cause.parameters[nearest];
}

}  // namespace driftlab::investigate
