#include "core/process/moving_average.hpp"

#include "core/process/haar_differences.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

/// m = k + r, and the sum over all lags of (1 - r) t_k + r t_(k+1), the triangles of unit slope.
struct Width {
  double k;
  double r;
  double sum;

  explicit Width(double samples)
      : k(std::floor(samples)), r(samples - k), sum((1.0 - r) * k * k + r * (k + 1.0) * (k + 1.0)) {}

  /// A law of the mixture, scaled to a sum of 1, from that of a triangle.
  template <class Law>
  [[nodiscard]] double mix(const Law& law) const {
    return ((1.0 - r) * law(k) + (r > 0.0 ? r * law(k + 1.0) : 0.0)) / sum;
  }
};

/// A function whose second difference in steps of one is the triangle t_k, up to terms that second differences of it
/// lose: |h| k^2/2 from k on, less by a constant than nearer the middle.
double lag_function(double k, double lag) {
  const double h = std::fabs(lag);
  return h < k ? 0.5 * k * h * h - h * (h * h - 1.0) / 6.0 : 0.5 * h * k * k - k * (k * k - 1.0) / 6.0;
}

double triangle_variance(double k, double m) {
  return (2.0 * lag_function(k, m) - 0.5 * lag_function(k, 2.0 * m)) / (m * m);
}

double triangle(double k, double lag) { return std::max(0.0, k - std::fabs(lag)); }

}  // namespace

double MovingAverage::haar_variance(double m, double dt_s) const {
  return n * n / dt_s * Width(samples).mix([m](double k) { return triangle_variance(k, m); });
}

void MovingAverage::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const Width width(samples);
  const double variance = width.mix([m](double k) { return triangle_variance(k, m); });
  const auto slope = [&](double k) {  // of the stretch from k to k + 1
    const double rise = triangle_variance(k + 1.0, m) - triangle_variance(k, m);
    return (rise - variance * (2.0 * k + 1.0)) / width.sum;
  };
  out[0] = 2.0 * n / dt_s * variance;
  out[1] = n * n / dt_s * (width.r > 0.0 ? slope(width.k) : 0.5 * (slope(width.k - 1.0) + slope(width.k)));
}

std::optional<double> MovingAverage::spectral_density(double f_hz, double dt_s) const {
  const double narrow = scaled_phase(f_hz * dt_s, 1.0).sine;
  return n * n * Width(samples).mix([&](double k) {
    const double wide = scaled_phase(f_hz * dt_s, k).sine;
    return narrow != 0.0 ? wide * wide / (narrow * narrow) : k * k;
  });
}

/// sinc^2(x) is 0.9 at x = 0.1755.
LowFrequencyDensity MovingAverage::low_frequency(double dt_s) const { return {n * n, 0.1755 / (samples * dt_s)}; }

std::optional<double> MovingAverage::autocovariance(double lag, double dt_s) const {
  return n * n / dt_s * Width(samples).mix([lag](double k) { return triangle(k, lag); });
}

double MovingAverage::variogram(double lag, double dt_s) const {
  return 2.0 * n * n / dt_s * Width(samples).mix([lag](double k) { return std::min(k, std::fabs(lag)); });
}

double MovingAverage::haar_cross(double mi, double mj, double h, double dt_s) const {
  if (h >= mi + mj + samples) {
    return 0.0;
  }
  return n * n / dt_s * Width(samples).mix([&](double k) {
    return haar_cross_of(mi, mj, h, [k](double lag) { return lag_function(k, lag); });
  });
}

/// A sample is the sum of the last k pieces of noise u and of the later part e, of length r, of the one before. State i
/// is what the pieces up to now give to the sample i later.
std::optional<StateSpace> MovingAverage::state_space(double dt_s) const {
  if (samples > kWidestStates) {
    return std::nullopt;
  }
  const Width width(samples);
  const double square = n * n / (dt_s * width.sum);
  const auto whole = static_cast<Eigen::Index>(width.k);
  const Eigen::Index states = whole + (width.r > 0.0 ? 1 : 0);
  StateSpace model;
  model.phi = Eigen::MatrixXd::Zero(states, states);
  model.phi.diagonal(1).setOnes();
  model.q = Eigen::MatrixXd::Constant(states, states, square);
  if (states > whole) {
    model.q.row(whole).setConstant(square * width.r);
    model.q.col(whole).setConstant(square * width.r);
  }
  model.cov0 = model.q;
  for (Eigen::Index step = 1; step < states; ++step) {
    model.cov0.topLeftCorner(states - step, states - step) += model.q.bottomRightCorner(states - step, states - step);
  }
  model.h = Eigen::RowVectorXd::Unit(states, 0);
  model.mean0 = Eigen::VectorXd::Zero(states);
  return model;
}

void MovingAverage::add_path(Random& random, double dt_s, std::span<double> out) const {
  const Width width(samples);
  const double scale = std::sqrt(n * n / (dt_s * width.sum));
  const double later_sd = std::sqrt(width.r);
  const double earlier_sd = std::sqrt(1.0 - width.r);
  // Sums of all pieces up to each, and the sums without the later part of the piece: y_t = sum_t - before_(t - k).
  const auto whole = static_cast<std::size_t>(width.k);
  std::vector<double> before(whole);
  double sum = 0.0;
  const auto draw = [&] {
    const double earlier = earlier_sd * random.normal();
    const double without_later = sum + earlier;
    sum = without_later + (width.r > 0.0 ? later_sd * random.normal() : 0.0);
    return without_later;
  };
  for (double& value : before) {
    value = draw();
  }
  std::size_t oldest = 0;
  for (double& value : out) {
    const double newest = draw();
    value += scale * (sum - before[oldest]);
    before[oldest] = newest;
    oldest = oldest + 1 == whole ? 0 : oldest + 1;
  }
}

}  // namespace driftlab
