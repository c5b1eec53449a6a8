#include "core/investigate/causes/causes.hpp"

namespace driftlab::investigate {

const std::vector<Cause>& cause_registry() {
  static const std::vector<Cause> all_causes{
      white_noise_level(),
      gauss_markov(),
      random_walk(),
      linear_drift(),
      flicker_noise(),
      quantization_noise(),
      output_resolution(),
      periodic_disturbance(),
      band_limited_noise(),
      heavy_tailed_noise(),
      noise_level_change(),
      common_mode_noise(),
      outliers(),
      bias_step(),
      turn_on_bias(),
      warm_up_transient(),
      temperature_bias(),
      stuck_samples(),
      missing_samples(),
      timestamp_jitter(),
      saturation(),
      rate_dependent_noise(),
      acceleration_dependent_noise(),
      scale_factor_error(),
      scale_factor_asymmetry(),
      scale_factor_nonlinearity(),
      axis_misalignment(),
      reference_time_offset(),
      reference_clock_drift(),
      once_per_revolution(),
      g_sensitivity(),
      vibration_rectification(),
      lever_arm(),
  };
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

}  // namespace driftlab::investigate
