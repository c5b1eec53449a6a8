#include "core/calibrate/triad.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <string>

namespace driftlab {

Result<TriadMean> triad_mean(const std::array<std::span<const double>, 3>& channels) {
  constexpr std::size_t kBatches = 20;
  const std::size_t count = channels[0].size();
  if (channels[1].size() != count || channels[2].size() != count) {
    return fail(ErrorCode::ShapeMismatch, "The three channels of a triad have different numbers of samples.");
  }
  if (count < 2 * kBatches) {
    return fail(ErrorCode::TooFewSamples,
                "The mean of a position needs at least 40 samples; there are " + std::to_string(count) + ".");
  }
  TriadMean result;
  const std::size_t each = count / kBatches;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span<const double> values = channels[axis];
    const double origin = values.front();  // a bias costs no digits
    double sum = 0.0;
    double batch_sum = 0.0;
    double batch_square = 0.0;
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
      double part = 0.0;
      for (std::size_t i = batch * each; i < (batch + 1) * each; ++i) {
        part += values[i] - origin;
      }
      sum += part;
      const double mean = part / static_cast<double>(each);
      batch_sum += mean;
      batch_square += mean * mean;
    }
    for (std::size_t i = kBatches * each; i < count; ++i) {
      sum += values[i] - origin;
    }
    result.mean[axis] = origin + sum / static_cast<double>(count);
    if (!std::isfinite(result.mean[axis])) {
      return fail(ErrorCode::NonFinite, "A channel of the triad holds a number that is not finite.");
    }
    constexpr double kN = kBatches;
    const double variance = std::max(0.0, (batch_square - batch_sum * batch_sum / kN) / (kN - 1.0));
    result.sigma[axis] = std::sqrt(variance / kN * (kN - 1.0) / (kN - 3.0));
  }
  return result;
}

Triple TriadLaw::correct(const Triple& reading) const {
  Eigen::Matrix3d law;
  Eigen::Vector3d right;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    right[i] = reading[row] - bias[row];
    for (int j = 0; j < 3; ++j) {
      law(i, j) = matrix[row][static_cast<std::size_t>(j)];
    }
  }
  const Eigen::Vector3d x = law.partialPivLu().solve(right);
  return {x[0], x[1], x[2]};
}

double length(const Triple& vector) { return std::hypot(vector[0], vector[1], vector[2]); }

}  // namespace driftlab
