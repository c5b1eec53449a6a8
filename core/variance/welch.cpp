#include "core/variance/welch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace driftlab {

WelchPeriodogram::WelchPeriodogram(std::size_t length, Taper taper, double dt_s)
    : window_(length, 1.0), sum_(length / 2 + 1, 0.0), windowed_(length), ordinates_(length / 2 + 1) {
  assert(length >= 2);
  double energy = 0.0;
  for (std::size_t t = 0; t < length; ++t) {
    if (taper == Taper::Hann) {
      window_[t] =
          0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(length));
    }
    energy += window_[t] * window_[t];
  }
  scale_ = dt_s / energy;
  fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
}

void WelchPeriodogram::add(std::span<const double> piece, PieceLine off) {
  assert(piece.size() == window_.size());
  for (std::size_t t = 0; t < window_.size(); ++t) {
    windowed_[t] = (piece[t] - off.slope * static_cast<double>(t) - off.level) * window_[t];
  }
  fft_.fwd(ordinates_.data(), windowed_.data(), static_cast<Eigen::Index>(windowed_.size()));
  for (std::size_t k = 0; k < sum_.size(); ++k) {
    sum_[k] += std::norm(ordinates_[k]) * scale_;
  }
  ++pieces_;
}

std::vector<double> WelchPeriodogram::mean() const {
  std::vector<double> density = sum_;
  for (double& value : density) {
    value /= std::max(1.0, static_cast<double>(pieces_));
  }
  return density;
}

}  // namespace driftlab
