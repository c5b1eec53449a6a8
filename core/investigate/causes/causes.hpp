#pragma once
/// The makers of all causes, one per file of this folder. A new one: its file, a line here, a line in registry.cpp.
#include "core/investigate/causes/cause.hpp"

namespace driftlab::investigate {

Cause white_noise_level();
Cause gauss_markov();
Cause random_walk();
Cause linear_drift();
Cause flicker_noise();
Cause quantization_noise();
Cause output_resolution();
Cause periodic_disturbance();
Cause band_limited_noise();
Cause heavy_tailed_noise();
Cause noise_level_change();
Cause common_mode_noise();
Cause outliers();
Cause bias_step();
Cause turn_on_bias();
Cause warm_up_transient();
Cause temperature_bias();
Cause stuck_samples();
Cause missing_samples();
Cause timestamp_jitter();
Cause saturation();
Cause rate_dependent_noise();
Cause acceleration_dependent_noise();
Cause scale_factor_error();
Cause scale_factor_asymmetry();
Cause scale_factor_nonlinearity();
Cause axis_misalignment();
Cause reference_time_offset();
Cause reference_clock_drift();
Cause once_per_revolution();
Cause g_sensitivity();
Cause vibration_rectification();
Cause lever_arm();

}  // namespace driftlab::investigate
