#include "core/variance/excess_kurtosis.hpp"

#include "core/process/dense.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace driftlab {

double difference_excess_kurtosis(std::span<const double> samples, const RunControl& control) {
  if (samples.size() < 3) {
    return 0.0;
  }
  const auto count = static_cast<double>(samples.size() - 1);
  const double mean = (samples.back() - samples.front()) / count;
  double second = 0.0;
  double fourth = 0.0;
  constexpr std::size_t kPoll = std::size_t{1} << 20U;
  for (std::size_t start = 1; start < samples.size(); start += kPoll) {
    if (control.stop.stop_requested()) {
      return 0.0;
    }
    constexpr std::size_t kLanes = 8;  // of independent sums, which is what a vector register wants
    std::array<double, kLanes> seconds{};
    std::array<double, kLanes> fourths{};
    const std::size_t end = std::min(samples.size(), start + kPoll);
    std::size_t t = start;
    for (; t + kLanes <= end; t += kLanes) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        const double d = samples[t + k] - samples[t + k - 1] - mean;
        const double square = d * d;
        seconds[k] += square;
        fourths[k] += square * square;
      }
    }
    for (; t < end; ++t) {
      const double d = samples[t] - samples[t - 1] - mean;
      seconds[0] += d * d;
      fourths[0] += d * d * d * d;
    }
    second = std::accumulate(seconds.begin(), seconds.end(), second);
    fourth = std::accumulate(fourths.begin(), fourths.end(), fourth);
  }
  if (!(second > 0.0) || !std::isfinite(fourth)) {
    return 0.0;
  }
  const double excess = fourth * count / (second * second) - 3.0;
  const double error = 2.0 * std::sqrt(24.0 / count);
  return std::fabs(excess) > 2.0 * error ? excess : 0.0;
}

double kurtosis_share(std::size_t half, std::size_t samples) {
  const double filter = 2.0 * static_cast<double>(half);
  const double count = static_cast<double>(samples) - filter + 1.0;
  const double a = std::min(filter, count);
  const double b = std::max(filter, count);
  const double overlap = a * a * (b - a + 1.0) + (a - 1.0) * a * (2.0 * a - 1.0) / 3.0;
  return overlap / (filter * filter * count * count);
}

double part_variance(const Model& model, double half, double dt_s, bool rough) {
  double sum = 0.0;
  for (const Process& process : model) {
    const bool smooth = process.kind->symbol == "RW" || process.kind->symbol == "DR" ||
                        (process.kind->symbol == "GM" && process.parameters[1] * dt_s < 0.3);
    if (smooth != rough) {
      sum += process.haar_variance(half, dt_s);
    }
  }
  return sum;
}

void add_kurtosis(Eigen::MatrixXd& covariance, const Eigen::VectorXd& part, std::span<const std::size_t> half,
                  std::size_t samples, double kurtosis) {
  Eigen::VectorXd direction(covariance.rows());
  for (Eigen::Index j = 0; j < direction.size(); ++j) {
    direction(j) = part(j) * std::sqrt(kurtosis_share(half[static_cast<std::size_t>(j)], samples));
  }
  if (kurtosis < 0.0) {  // C + k v v' stays positive while -k v' C^-1 v < 1
    const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
    const Eigen::MatrixXd correlation = sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
    const Eigen::VectorXd scaled = direction.cwiseQuotient(sd);
    const double reach = scaled.dot(solve_symmetric(correlation, scaled));
    kurtosis = reach > 0.0 ? std::max(kurtosis, -0.9 / reach) : 0.0;
  }
  covariance += kurtosis * direction * direction.transpose();
}

void add_kurtosis(Eigen::MatrixXd& covariance, const Model& model, std::span<const double> half, std::size_t samples,
                  double dt_s, const NoiseShape& shape) {
  if (shape.kurtosis == 0.0) {
    return;
  }
  Eigen::VectorXd part(covariance.rows());
  std::vector<std::size_t> whole;
  for (Eigen::Index j = 0; j < part.size(); ++j) {
    const double m = half[static_cast<std::size_t>(j)];
    part(j) = part_variance(model, m, dt_s, shape.rough);
    whole.push_back(static_cast<std::size_t>(m));
  }
  add_kurtosis(covariance, part, whole, samples, shape.kurtosis);
}

}  // namespace driftlab
