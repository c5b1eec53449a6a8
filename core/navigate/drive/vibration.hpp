#pragma once
/// How strongly an inertial unit is shaken, over time: the power of its readings above about 5 Hz.
///
/// The noise of a shaken unit grows: nonlinear scale factors rectify vibration, and vibration above the sensor's band
/// is aliased into it. The power is the mean square of what a moving mean over a tenth of a second leaves of the
/// readings (half at 4.4 Hz), in blocks of half a second. White noise
///   N^2(t) = N^2 (1 - s + s P(t)/mean P)
/// has the same mean for every share s, so that s says when there is noise and the level how much. Of the share, and
/// not of s/(1 - s): where nearly all the noise follows the vibration that ratio has no upper end in the data.
#include "core/navigate/imu_model.hpp"
#include "core/navigate/motion.hpp"

#include <array>
#include <span>
#include <vector>

namespace driftlab::drive {

class Vibration {
 public:
  Vibration() = default;
  /// O(readings).
  Vibration(std::span<const ImuSample> readings, double dt_s);

  /// P(t)/mean P of each axis at a reading; 1 where nothing is known.
  [[nodiscard]] const std::array<double, kImuChannels>& at(std::size_t reading) const;
  /// The first reading of the next block.
  [[nodiscard]] std::size_t next_block(std::size_t reading) const;
  /// The same, counted from a later reading.
  [[nodiscard]] Vibration from(std::size_t reading) const;

 private:
  std::size_t every_ = 1;   ///< readings in a block
  std::size_t offset_ = 0;  ///< readings before the first one counted
  std::vector<std::array<double, kImuChannels>> relative_{};
};

/// Squared density of the white noise of an axis at its first operating point, 0 without such noise.
[[nodiscard]] double white_square_of(const AxisModel& axis);

}  // namespace driftlab::drive
