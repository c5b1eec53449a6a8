#pragma once
/// How much of what a channel reads is motion, and how much its own white noise.
///
/// Means over windows of T have a variance of (motion's) + N^2/T about their mean. The ratio bounds what a filter can
/// tell of a channel's scale: on an axis that hardly moves the best reading is a smaller one, (1 - N^2/(motion + N^2))
/// of it (Wiener's), whatever the scale is. A likelihood of fixes then shows a scale factor of about noise over motion
/// that is nobody's, and outages that it has not seen gain from it.
#include "core/navigate/drive/filter_options.hpp"

namespace driftlab::drive {

struct MotionPower {
  double motion = 0.0;  ///< variance of means over windows beyond that of the noise, >= 0
  double noise = 0.0;   ///< N^2/T, with the options' level of N
};

/// Of a channel of the whole drive; zero windows: both 0. O(readings). `window_s` > 0.
[[nodiscard]] MotionPower motion_power(const Drive& drive, const FilterOptions& options, std::size_t channel,
                                       double window_s);

/// The scale factor that a channel shows though it has none: noise over motion, in windows as long as a filter keeps
/// an angle or a velocity to itself between fixes. Infinite for a channel without motion.
[[nodiscard]] double scale_of_noise(const Drive& drive, const FilterOptions& options, std::size_t channel);

}  // namespace driftlab::drive
