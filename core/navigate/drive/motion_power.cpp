#include "core/navigate/drive/motion_power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::drive {
namespace {

constexpr double kKept = 5.0;  ///< [s]

}  // namespace

MotionPower motion_power(const Drive& drive, const FilterOptions& options, std::size_t channel, double window_s) {
  double squares = 0.0;
  double windows = 0.0;
  double per_second = 0.0;
  for (const UniformRun& run : drive.runs) {
    const auto length = static_cast<std::size_t>(std::max(1L, std::lround(window_s / run.dt_s)));
    double sum = 0.0;
    double square = 0.0;
    double count = 0.0;
    for (std::size_t first = 0; first + length <= run.readings.size(); first += length) {
      double mean = 0.0;
      for (std::size_t i = first; i < first + length; ++i) {
        mean += run.readings[i][channel] / static_cast<double>(length);
      }
      sum += mean;
      square += mean * mean;
      count += 1.0;
    }
    squares += count > 0.0 ? square - sum * sum / count : 0.0;
    windows += count;
    per_second += count / (static_cast<double>(length) * run.dt_s);  // a window holds whole readings
  }
  if (windows == 0.0) {
    return {};
  }
  const double level = channel < 3 ? options.gyro_noise : options.force_noise;
  MotionPower power;
  power.noise = level * level * white_square_of(drive.document.model.axes[channel]) * per_second / windows;
  power.motion = std::max(squares / windows - power.noise, 0.0);
  return power;
}

double scale_of_noise(const Drive& drive, const FilterOptions& options, std::size_t channel) {
  const MotionPower power = motion_power(drive, options, channel, kKept);
  return power.motion > 0.0 ? power.noise / power.motion : std::numeric_limits<double>::infinity();
}

}  // namespace driftlab::drive
