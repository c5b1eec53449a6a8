#include "core/calibrate/time_alignment.hpp"

#include "core/process/distributions.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// Value and derivative (per sample) of a series between its samples, by cubic convolution. Precondition: 1 <= at <
/// size - 2.
struct Between {
  double value = 0.0;
  double slope = 0.0;
};

Between interpolate(std::span<const double> series, double at) {
  const double whole = std::floor(at);
  const double t = at - whole;
  const auto i = static_cast<std::size_t>(whole);
  const double p0 = series[i - 1];
  const double p1 = series[i];
  const double p2 = series[i + 1];
  const double p3 = series[i + 2];
  const double c1 = 0.5 * (p2 - p0);
  const double c2 = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3;
  const double c3 = 0.5 * (p3 - p0) + 1.5 * (p1 - p2);
  return {p1 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3)};
}

/// Correlation of measured[i] with reference[i - lag] over [first, last).
double correlation_at(std::span<const double> measured, std::span<const double> reference, std::ptrdiff_t lag,
                      std::size_t first, std::size_t last) {
  double sm = 0.0;
  double sr = 0.0;
  double smm = 0.0;
  double srr = 0.0;
  double smr = 0.0;
  const double m0 = measured[first];
  const double r0 = reference[first];
  for (std::size_t i = first; i < last; ++i) {
    const double m = measured[i] - m0;
    const double r = reference[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) - lag)] - r0;
    sm += m;
    sr += r;
    smm += m * m;
    srr += r * r;
    smr += m * r;
  }
  const auto n = static_cast<double>(last - first);
  const double product = (smm - sm * sm / n) * (srr - sr * sr / n);
  return product > 0.0 ? (smr - sm * sr / n) / std::sqrt(product) : 0.0;
}

/// The samples compared, and the best whole lag among them.
struct Coarse {
  std::size_t first = 0;
  std::size_t last = 0;
  std::ptrdiff_t lag = 0;
  double correlation = 0.0;
};

Coarse best_whole_lag(std::span<const double> measured, std::span<const double> reference, std::size_t most) {
  Coarse coarse{most + 3, measured.size() - most - 3, 0, -2.0};
  const auto reach = static_cast<std::ptrdiff_t>(most);
  for (std::ptrdiff_t lag = -reach; lag <= reach; ++lag) {
    // A reference of the other sign is a wrong axis, not a delay: the gain must be positive.
    const double correlation = correlation_at(measured, reference, lag, coarse.first, coarse.last);
    if (correlation > coarse.correlation) {
      coarse.correlation = correlation;
      coarse.lag = lag;
    }
  }
  return coarse;
}

using Theta = Eigen::Vector3d;  // a, k, delay in samples

/// One pass over the compared samples: normal equations, and on request the scores.
struct Pass {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double square = 0.0;
  std::vector<Eigen::Vector3d> scores;
};

Pass pass(std::span<const double> measured, std::span<const double> reference, const Coarse& coarse, const Theta& theta,
          bool keep_scores) {
  Pass result;
  for (std::size_t i = coarse.first; i < coarse.last; ++i) {
    const Between r = interpolate(reference, static_cast<double>(i) - theta[2]);
    const double error = measured[i] - theta[0] - theta[1] * r.value;
    const Eigen::Vector3d row(1.0, r.value, -theta[1] * r.slope);
    result.normal += row * row.transpose();
    result.gradient += row * error;
    result.square += error * error;
    if (keep_scores) {
      result.scores.emplace_back(row * error);
    }
  }
  return result;
}

/// The long-run covariance of the scores: prewhitened by the correlation of successive errors (the first element of a
/// score), Bartlett weights over n^(1/3) lags of what is left, recoloured (Andrews and Monahan 1992, with one
/// coefficient for all).
Eigen::Matrix3d long_run(const std::vector<Eigen::Vector3d>& scores) {
  constexpr double kMost = 0.97;
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    product += scores[i][0] * scores[i - 1][0];
    square += scores[i - 1][0] * scores[i - 1][0];
  }
  const double rho = square > 0.0 ? std::clamp(product / square, -kMost, kMost) : 0.0;
  std::vector<Eigen::Vector3d> white;
  white.reserve(scores.size());
  for (std::size_t i = 1; i < scores.size(); ++i) {
    white.emplace_back(scores[i] - rho * scores[i - 1]);
  }
  const auto lags = static_cast<std::size_t>(std::cbrt(static_cast<double>(white.size())));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = lag; i < white.size(); ++i) {
      covariance += white[i] * white[i - lag].transpose();
    }
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    sum += lag == 0 ? covariance : Eigen::Matrix3d(weight * (covariance + covariance.transpose()));
  }
  return sum / ((1.0 - rho) * (1.0 - rho));
}

Status check(std::span<const double> measured, std::span<const double> reference, double dt_s, double max_shift_s) {
  if (measured.size() != reference.size()) {
    return fail(ErrorCode::ShapeMismatch, "The channel and its reference have different numbers of samples.");
  }
  if (!(dt_s > 0.0 && max_shift_s >= dt_s && std::isfinite(max_shift_s))) {
    return fail(ErrorCode::InvalidArgument, "The largest shift must be one sample interval or more.",
                {{"parameter", "max_shift_s"}});
  }
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(measured.begin(), measured.end(), finite) ||
      !std::all_of(reference.begin(), reference.end(), finite)) {
    return fail(ErrorCode::NonFinite, "The channel or its reference holds a number that is not finite.");
  }
  if (static_cast<double>(measured.size()) < 2.0 * max_shift_s / dt_s + 24.0) {
    return fail(ErrorCode::TooFewSamples, "The recording is too short to be aligned over so large a shift.");
  }
  return {};
}

}  // namespace

Result<TimeAlignment> align_reference(std::span<const double> measured, std::span<const double> reference, double dt_s,
                                      const AlignmentOptions& options) {
  if (auto status = check(measured, reference, dt_s, options.max_shift_s); !status) {
    return fail(status.error());
  }
  const auto most = static_cast<std::size_t>(std::floor(options.max_shift_s / dt_s));
  const Coarse coarse = best_whole_lag(measured, reference, most);
  if (!(coarse.correlation > 0.0)) {
    return fail(ErrorCode::InvalidArgument,
                "The channel does not follow its reference: is one of them constant, or reversed?",
                {{"parameter", "reference"}});
  }
  Theta theta(0.0, 1.0, static_cast<double>(coarse.lag));
  TimeAlignment result;
  const double limit = static_cast<double>(most) + 1.0;
  for (int iteration = 0; iteration < 50 && !result.converged; ++iteration) {
    const Pass now = pass(measured, reference, coarse, theta, false);
    Eigen::Vector3d step = now.normal.ldlt().solve(now.gradient);
    if (!step.allFinite()) {
      break;
    }
    step[2] = std::clamp(step[2], -1.0, 1.0);
    theta += step;
    theta[2] = std::clamp(theta[2], -limit, limit);
    result.converged = std::abs(step[2]) < 1e-9;
  }
  const Pass last = pass(measured, reference, coarse, theta, true);
  const Eigen::Matrix3d inverse = last.normal.inverse();
  const Eigen::Matrix3d covariance = inverse * long_run(last.scores) * inverse;
  const double half = kNormal975 * std::sqrt(std::max(covariance(2, 2), 0.0)) * dt_s;
  result.samples = coarse.last - coarse.first;
  result.delay_s = {theta[2] * dt_s, {theta[2] * dt_s - half, theta[2] * dt_s + half}};
  result.offset = theta[0];
  result.gain = theta[1];
  result.residual_rms = std::sqrt(last.square / static_cast<double>(result.samples));
  const std::vector<double> moved = delayed(reference, theta[2]);
  result.correlation = correlation_at(measured, moved, 0, coarse.first, coarse.last);
  if (!result.converged) {
    result.warnings.emplace_back("The search for the delay did not converge.");
  }
  if (std::abs(theta[2]) >= static_cast<double>(most)) {
    result.warnings.emplace_back("The delay lies at the end of the range that was searched.");
  }
  return result;
}

std::vector<double> delayed(std::span<const double> series, double delay_samples) {
  std::vector<double> moved(series.size());
  if (series.size() < 4) {
    std::copy(series.begin(), series.end(), moved.begin());
    return moved;
  }
  const double last = static_cast<double>(series.size()) - 2.0 - 1e-9;
  for (std::size_t i = 0; i < series.size(); ++i) {
    moved[i] = interpolate(series, std::clamp(static_cast<double>(i) - delay_samples, 1.0, last)).value;
  }
  return moved;
}

}  // namespace driftlab
