#pragma once
/// Frames of a recording in which a narrow band is louder than in the others.
///
/// A recording is cut into frames of one second. Its innovations are whitened by an autoregression first, and each
/// ordinate of the frames' periodograms is divided by its mean over the recording: under any stationary Gaussian noise,
/// however narrow its band, an ordinate is then about a unit exponential. Bursts are therefore compared with stationary
/// noise of any spectrum, not only with that of the model. With x the mean power of a frame inside a band over that
/// outside it, the likelihood of two kinds of frames, a fraction of them louder by a factor, is compared with that of
/// one kind (two_kinds.hpp), whatever the level of each frame is. Noise whose band is narrow against a hertz swells and
/// fades by itself over many frames; its phase goes on from one frame to the next, and by this it is told from bursts.
#include "core/investigate/fullrate/full_rate.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab::investigate {

struct Burstiness {
  double centre_hz = 0.0;  ///< of the band
  double gain = 0.0;       ///< twice the log likelihood over one kind of frames
  double fraction = 0.0;   ///< p
  double bursts = 0.0;     ///< runs of loud frames
  double amplitude = 0.0;  ///< rms of what the band holds more in loud frames [SI]
  double amplitude_sd = 0.0;
  double frequency_hz = 0.0;  ///< centroid of the power that it holds more
  double frequency_sd = 0.0;
  double coherence = 0.0;  ///< share of that power that goes on in the next frame with its phase
};

/// The band of a scope in which the frames differ most; `tried` is set to the number of bands. No band below 2 Hz is
/// examined, since slow noise comes and goes there too. Fewer than thirty frames give no result. Bursts that occur at
/// most once per recording are not reported (a change, or an oscillation whose frequency runs through the band), nor is
/// a band that is nearly a line.
[[nodiscard]] std::optional<Burstiness> strongest_bursts(const FullRate& data, const std::vector<std::size_t>& scope,
                                                         double& tried);

/// The two kinds of frames in the band about a frequency, however little they differ.
[[nodiscard]] Burstiness bursts_near(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz);

/// Log likelihood that bursts of known amplitude [SI] and fraction gain, the scale at rest free.
[[nodiscard]] double burst_gain(const FullRate& data, const std::vector<std::size_t>& scope, double centre_hz,
                                double amplitude, double fraction);

/// The excess of the band in the loud frames of member r of the scope [SI]. With it subtracted, the band keeps the
/// power that it has outside the bursts.
[[nodiscard]] std::vector<double> burst_values(const FullRate& data, const std::vector<std::size_t>& scope,
                                               std::size_t r, double centre_hz);

}  // namespace driftlab::investigate
