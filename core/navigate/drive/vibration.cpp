#include "core/navigate/drive/vibration.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kMeanOver = 0.1;    ///< [s]
constexpr double kPowerBlock = 0.5;  ///< [s]
constexpr std::array<double, kImuChannels> kEven{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

}  // namespace

Vibration::Vibration(std::span<const ImuSample> readings, double dt_s) {
  const auto half = static_cast<std::size_t>(std::max(1L, std::lround(0.5 * kMeanOver / dt_s)));
  every_ = static_cast<std::size_t>(std::max(1L, std::lround(kPowerBlock / dt_s)));
  const std::size_t blocks = readings.size() / every_;
  relative_.assign(blocks, {});
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    std::vector<double> sums(readings.size() + 1, 0.0);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      sums[i + 1] = sums[i] + readings[i][c];
    }
    double mean = 0.0;
    for (std::size_t i = 0; i < blocks * every_; ++i) {
      const std::size_t first = i > half ? i - half : 0;
      const std::size_t last = std::min(i + half + 1, readings.size());
      const double rest = readings[i][c] - (sums[last] - sums[first]) / static_cast<double>(last - first);
      relative_[i / every_][c] += rest * rest;
      mean += rest * rest;
    }
    mean /= static_cast<double>(std::max<std::size_t>(blocks, 1));
    for (auto& block : relative_) {
      block[c] = mean > 0.0 ? block[c] / mean : 1.0;
    }
  }
}

const std::array<double, kImuChannels>& Vibration::at(std::size_t reading) const {
  return relative_.empty() ? kEven : relative_[std::min((reading + offset_) / every_, relative_.size() - 1)];
}

std::size_t Vibration::next_block(std::size_t reading) const {
  return ((reading + offset_) / every_ + 1) * every_ - offset_;
}

Vibration Vibration::from(std::size_t reading) const {
  Vibration later = *this;
  later.offset_ += reading;
  return later;
}

double white_square_of(const AxisModel& axis) {
  double square = 0.0;
  for (const Process& process : axis.processes.model(0)) {
    if (process.kind->white_square != nullptr) {
      square += process.kind->white_square(process.parameters);
    }
  }
  return square;
}

}  // namespace driftlab::drive
