#pragma once
/// Simulation of an inertial unit whose errors follow its error model.
///
/// reading = quantize(clip(low-pass(M s) + b + eps)), where s is the ideal output, and per axis (seed paper eq. 9 and
/// 10, with the scale factor on the true value)
///   M = I + misalignment + diag(scale factor)   deterministic, per sensor triad,
///   b = given bias + a draw N(0, bias_sd^2)     constant over the run,
///   eps                                         the sum of the model's processes.
/// The low-pass (second-order Butterworth, bilinear) acts on the motion only, because noise models describe the noise
/// of the readings. Under a schedule of several bands eps follows the true rate. White noise, Gauss-Markov and
/// random-walk processes keep their state while their parameters change; any other process switches between paths that
/// share their random draws.
#include "core/navigate/imu_model.hpp"
#include "core/process/random.hpp"

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace driftlab {

/// What the electronics and the assembly do, equal in every run.
struct ImuHardware {
  std::array<double, kImuChannels> bias{};               ///< [rad/s or m/s^2]
  std::array<double, kImuChannels> scale_factor{};       ///< relative error
  Matrix3 gyroscope_misalignment = Matrix3::Zero();      ///< [rad] row: what the axis reads of the others
  Matrix3 accelerometer_misalignment = Matrix3::Zero();  ///< [rad]
  std::array<double, kImuChannels> quantization_step{};  ///< 0: none
  std::array<double, kImuChannels> range{};              ///< clipped at +-range; 0: never
  std::array<double, kImuChannels> bandwidth_hz{};       ///< 0, or at or above half the rate: no filter
};

/// Errors: InvalidArgument naming the member: a number that is not finite, a negative step, range or bandwidth.
[[nodiscard]] Status check(const ImuHardware& hardware);

/// Readings of one run and what was drawn for it.
struct ImuRun {
  std::vector<ImuSample> readings;
  std::array<double, kImuChannels> bias{};  ///< given and drawn
};

/// `ideal` at dt_s. Stream 16 `run` + channel of `seed` makes the noise of a channel, so channels and runs are
/// independent and adding a process to one channel leaves the others as they were. Time and memory linear in the
/// samples. Looks at `stop` between channels; the readings are then not to be used.
[[nodiscard]] ImuRun simulate_imu(std::span<const ImuSample> ideal, double dt_s, const ImuModel& model,
                                  const ImuHardware& hardware, std::uint64_t seed, std::uint64_t run,
                                  const std::stop_token& stop = {});

/// The stochastic error of one axis: one value per sample, its band chosen by `rates_rad_s` (one per sample; empty
/// where the schedule has one band).
[[nodiscard]] std::vector<double> simulate_axis(const ModelSchedule& schedule, std::span<const double> rates_rad_s,
                                                double dt_s, std::size_t samples, Random& random);

}  // namespace driftlab
