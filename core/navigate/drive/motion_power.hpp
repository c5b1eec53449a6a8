#pragma once
/// The power of a channel's readings, split into motion and the channel's own white noise.
///
/// Means of the readings over windows of length T have the variance motion + noise, where noise = N^2/T. The ratio of
/// the two limits how well a filter can determine the channel's scale factor. On an axis that hardly moves, the
/// estimate of the motion with the least error is the reading times motion/(motion + noise) (Wiener filter), for any
/// true scale factor. The likelihood of the fixes therefore shows an apparent scale factor of about noise/motion that
/// the sensor does not have, and it improves held-out outages too.
#include "core/navigate/drive/filter_options.hpp"

namespace driftlab::drive {

struct MotionPower {
  double motion = 0.0;  ///< variance of means over windows beyond that of the noise, >= 0
  double noise = 0.0;   ///< N^2/T, with the options' level of N
};

/// For one channel over the whole drive; both are 0 if no window fits. O(readings). `window_s` > 0.
[[nodiscard]] MotionPower motion_power(const Drive& drive, const FilterOptions& options, std::size_t channel,
                                       double window_s);

/// The apparent scale factor of a channel without a scale-factor error: noise over motion in windows of 5 s, for about
/// so long a filter keeps an angle or a velocity by itself between fixes. Infinite for a channel without motion.
[[nodiscard]] double scale_of_noise(const Drive& drive, const FilterOptions& options, std::size_t channel);

}  // namespace driftlab::drive
