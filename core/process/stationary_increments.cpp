#include "core/process/stationary_increments.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <vector>

namespace driftlab {

std::size_t embedding_lags(std::size_t samples) {
  std::size_t power = 1;
  while (power < samples) {
    power *= 2;
  }
  return power + 1;
}

void add_path_of_increments(std::span<const double> covariance, Random& random, std::span<double> out) {
  assert(covariance.size() == embedding_lags(out.size()));
  if (out.empty()) {
    return;
  }
  const std::size_t circle = 2 * (covariance.size() - 1);
  std::vector<std::complex<double>> row(circle);
  for (std::size_t h = 0; h <= circle / 2; ++h) {
    row[h] = covariance[h];
    if (h > 0 && h < circle / 2) {
      row[circle - h] = covariance[h];
    }
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum(circle);
  fft.fwd(spectrum.data(), row.data(), static_cast<Eigen::Index>(circle));
  for (std::size_t k = 0; k < circle; ++k) {
    const double power = std::max(spectrum[k].real(), 0.0);
    const double scale = std::sqrt(power / static_cast<double>(circle));
    const double re = random.normal();
    const double im = random.normal();
    spectrum[k] = scale * std::complex<double>(re, im);
  }
  fft.fwd(row.data(), spectrum.data(), static_cast<Eigen::Index>(circle));
  double level = 0.0;
  for (std::size_t t = 0; t < out.size(); ++t) {
    out[t] += level;
    level += row[t].real();
  }
}

}  // namespace driftlab
