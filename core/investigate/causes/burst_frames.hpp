#pragma once
/// Frames of a recording in which a narrow band is louder than in the others.
///
/// A recording is cut into frames of one second. With x the mean power of a frame inside a band over that outside it, m
/// and M ordinates each, x / s is F-distributed under the model whatever the level of the frame is, s the scale of the
/// band; its density is, but for a constant, s^-m (1 + m x / (M s))^-(m + M). In a burst s is larger by a factor rho.
/// The likelihood of two kinds of frames, a fraction p of them loud, is compared with that of one kind, s free in both.
#include "core/investigate/fullrate/full_rate.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab::investigate {

struct Burstiness {
  double centre_hz = 0.0;
  double width_hz = 0.0;
  double scale = 1.0;     ///< of the band at rest
  double ratio = 1.0;     ///< rho
  double fraction = 0.0;  ///< p
  double gain = 0.0;      ///< twice the log likelihood over one kind of frames
  double frames = 0.0;
  double ordinates = 0.0;  ///< m
};

/// The band of a scope in which frames differ most; `tried` is set to the number of bands. Nothing below 2 Hz, where
/// what is slow comes and goes too, and nothing in fewer than thirty frames.
[[nodiscard]] std::optional<Burstiness> strongest_bursts(const FullRate& data, const std::vector<std::size_t>& scope,
                                                         double& tried);

/// The two kinds of frames in the band about a frequency, however little they differ.
[[nodiscard]] Burstiness bursts_near(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz);

/// Log likelihood that bursts of known amplitude [SI] and fraction gain, the scale at rest free.
[[nodiscard]] double burst_gain(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz,
                                double amplitude, double fraction);

/// What the band holds in the loud frames of member r, to be subtracted [SI].
[[nodiscard]] std::vector<double> burst_values(const FullRate& data, std::size_t r, double centre_hz, double amplitude,
                                               double fraction);

}  // namespace driftlab::investigate
