#pragma once
/// Whether each recording shows its stated motion, by the gain of every channel on that motion and by its noise.
///
/// Per recording, the channels of a quantity are regressed on the motion that drives them: on the reference where it
/// varies, by means over a second, jointly on all axes that move; where it is constant, the gain is
///   (mean - b) / w,   b the median of the channel's means over the recordings in which nothing drives it.
/// In a recording that is what its description says, a channel has a gain of 1 on its own axis and of 0 on the others.
/// Errors of calibration are small and the same in all recordings. A gain that is off by more than a tenth in one
/// recording is therefore an error of that recording: a turned sign (-1), exchanged axes (0, and 1 on another axis),
/// another unit (a known factor), or another motion than the one stated. A wrong unit scales the noise by the same
/// factor; the noise is compared at rest and where a bias hides the gain.
/// Samples at a clipped extreme are left out.
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

namespace driftlab::investigate {

enum class RecordingDoubt {
  TurnedSign,
  SwappedAxes,
  OtherUnit,
  NoResponse,  ///< the gain is below a tenth: the channel does not follow the motion
  OddGain,     ///< a gain that neither sign, axis nor unit explains, and that other recordings do not have
};

struct DoubtfulRecording {
  RecordingDoubt doubt = RecordingDoubt::OddGain;
  std::size_t recording = 0;
  std::size_t channel = 0;  ///< of the recording
  std::size_t other = 0;    ///< the channel it is exchanged with
  bool turned = false;      ///< exchanged, and with the sign of the motion turned
  double factor = 1.0;      ///< reading over true value: the gain, or the factor of the unit
  double deviation = 0.0;   ///< of the gain
};

/// Every channel of every recording that does not show its stated motion, axis, sign or unit. A wrong unit is found
/// only with two other recordings or a motion. Nothing once `stop` is asked. O(samples).
[[nodiscard]] std::vector<DoubtfulRecording> doubtful_recordings(const Study& study, const std::stop_token& stop);

}  // namespace driftlab::investigate
