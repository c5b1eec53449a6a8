#include "core/calibrate/multi_position.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr Eigen::Index kNumbers = 9;
constexpr std::size_t kFewest = 10;
constexpr int kMostIterations = 200;

using Parameters = Eigen::Matrix<double, kNumbers, 1>;

/// Readings brought to the size of 1, so that nine numbers of any unit are of one size: u = (y - middle) / width.
struct Scaled {
  std::vector<Eigen::Vector3d> readings;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d width = Eigen::Vector3d::Ones();
};

/// Parameters: A in units of g/width (xx, xy, xz, yy, yz, zz), then b in units of width from the middle.
Eigen::Matrix3d matrix_of(const Parameters& p) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  a << p[0], p[1], p[2], 0.0, p[3], p[4], 0.0, 0.0, p[5];
  return a;
}

/// Residuals |x| - 1 and their derivatives.
double evaluate(const Scaled& scaled, const Parameters& p, Eigen::MatrixXd* jacobian, Eigen::VectorXd& residuals) {
  const Eigen::Matrix3d a = matrix_of(p);
  const Eigen::Vector3d b = p.tail<3>();
  const auto n = static_cast<Eigen::Index>(scaled.readings.size());
  residuals.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Vector3d v = scaled.readings[static_cast<std::size_t>(k)] - b;
    const Eigen::Vector3d x = a * v;
    const double size = x.norm();
    residuals[k] = size - 1.0;
    if (jacobian != nullptr) {
      const Eigen::Vector3d u = size > 0.0 ? Eigen::Vector3d(x / size) : Eigen::Vector3d::Zero();
      jacobian->row(k) << u[0] * v[0], u[0] * v[1], u[0] * v[2], u[1] * v[1], u[1] * v[2], u[2] * v[2],
          -(a.transpose() * u).transpose();
    }
  }
  return residuals.squaredNorm();
}

Result<Scaled> scale(std::span<const Triple> readings) {
  Scaled scaled;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Triple& reading : readings) {
    const Eigen::Vector3d y(reading[0], reading[1], reading[2]);
    if (!y.allFinite()) {
      return fail(ErrorCode::NonFinite, "A position of the calibration is not finite.");
    }
    low = low.cwiseMin(y);
    high = high.cwiseMax(y);
    scaled.readings.push_back(y);
  }
  scaled.middle = 0.5 * (low + high);
  scaled.width = 0.5 * (high - low);
  if (!(scaled.width.minCoeff() > 0.05 * scaled.width.maxCoeff())) {
    return fail(ErrorCode::TooFewSamples, "The positions leave an axis always at the same angle; turn it up and down.");
  }
  for (Eigen::Vector3d& y : scaled.readings) {
    y = (y - scaled.middle).cwiseQuotient(scaled.width);
  }
  return scaled;
}

struct Solution {
  Parameters p = Parameters::Zero();
  double square = 0.0;
  int iterations = 0;
  bool converged = false;
  Parameters deviation = Parameters::Zero();  ///< standard deviation per unit of residual scatter
  double condition = 0.0;
};

/// Condition and deviations from the normal matrix. Directions along which the residuals do not change leave every
/// number that they move without bound.
void measure_spread(const Eigen::MatrixXd& normal, Solution& found) {
  constexpr double kRounding = 1e-14;  // of the largest eigenvalue: below it, an eigenvalue is rounding
  constexpr double kMoved = 1e-10;     // square of a direction's part along a number
  const SymmetricEigen eigen = symmetric_eigen(normal);
  const double largest = eigen.values[kNumbers - 1];
  found.condition = eigen.values[0] > 0.0 ? largest / eigen.values[0] : std::numeric_limits<double>::infinity();
  Parameters variance = Parameters::Zero();
  for (Eigen::Index k = 0; k < kNumbers; ++k) {
    const Parameters square = eigen.vectors.col(k).cwiseAbs2();
    const bool seen = eigen.values[k] > kRounding * largest;
    for (Eigen::Index i = 0; i < kNumbers; ++i) {
      if (seen) {
        variance[i] += square[i] / eigen.values[k];
      } else if (square[i] > kMoved) {
        variance[i] = std::numeric_limits<double>::infinity();
      }
    }
  }
  found.deviation = variance.cwiseSqrt();
}

Solution solve(const Scaled& scaled) {
  Solution found;
  found.p << 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0;
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(scaled.readings.size()), kNumbers);
  Eigen::VectorXd residuals;
  found.square = evaluate(scaled, found.p, &jacobian, residuals);
  double damping = 1e-3;
  while (found.iterations < kMostIterations && !found.converged) {
    ++found.iterations;
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal() *= 1.0 + damping;
    const Parameters step = solve_symmetric(normal, Eigen::VectorXd(-(jacobian.transpose() * residuals)));
    Eigen::VectorXd trial_residuals;
    const double square = evaluate(scaled, found.p + step, nullptr, trial_residuals);
    if (std::isfinite(square) && square <= found.square) {
      found.converged = step.norm() < 1e-12 || found.square - square <= 1e-14 * found.square;
      found.p += step;
      found.square = evaluate(scaled, found.p, &jacobian, residuals);
      damping = std::max(damping * 0.1, 1e-12);
    } else {
      damping *= 10.0;
      found.converged = damping > 1e12 && step.norm() < 1e-9;
    }
  }
  measure_spread(jacobian.transpose() * jacobian, found);
  return found;
}

/// rms of |k y| - g with the factor k = g sum|y| / sum|y|^2 that makes it smallest.
double best_single_factor(std::span<const Triple> readings, double gravity) {
  double sum = 0.0;
  double square = 0.0;
  for (const Triple& reading : readings) {
    sum += length(reading);
    square += length(reading) * length(reading);
  }
  double residual = 0.0;
  for (const Triple& reading : readings) {
    const double error = gravity * sum / square * length(reading) - gravity;
    residual += error * error;
  }
  return std::sqrt(residual / static_cast<double>(readings.size()));
}

}  // namespace

Triple MultiPositionCalibration::correct(const Triple& reading) const {
  Triple corrected{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      corrected[i] += correction[i][j].value * (reading[j] - bias[j].value);
    }
  }
  return corrected;
}

AxisAngles MultiPositionCalibration::misalignment() const {
  const auto& a = correction;
  const std::array<double, 3> diagonal{a[0][0].value, a[1][1].value, a[2][2].value};
  AxisAngles angles{};
  const double between = a[0][1].value * a[1][2].value / (diagonal[1] * diagonal[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 3; ++j) {
      const double angle = -a[i][j].value / diagonal[j] + (j == i + 2 ? between : 0.0);
      const double half = a[i][j].ci95.half_width() / std::abs(diagonal[j]);
      angles[i][j] = Estimate{angle, {angle - half, angle + half}};
    }
  }
  return angles;
}

Result<MultiPositionCalibration> calibrate_multi_position(std::span<const Triple> readings, double gravity_m_s2) {
  if (!(gravity_m_s2 > 0.0 && std::isfinite(gravity_m_s2))) {
    return fail(ErrorCode::InvalidArgument, "Gravity must be a positive number of m/s^2.", {{"parameter", "gravity"}});
  }
  if (readings.size() < kFewest) {
    return fail(ErrorCode::TooFewSamples,
                "Nine numbers need at least ten positions; there are " + std::to_string(readings.size()) + ".");
  }
  auto scaled = scale(readings);
  if (!scaled) {
    return fail(scaled.error());
  }
  const Solution found = solve(*scaled);
  const double dof = static_cast<double>(readings.size()) - static_cast<double>(kNumbers);
  const double half = student_quantile(0.975, dof) * std::sqrt(found.square / dof);
  const auto spread_of = [&](Eigen::Index number, double factor) {
    const double deviation = found.deviation[number];
    return std::isfinite(deviation) ? factor * half * deviation : deviation;
  };
  MultiPositionCalibration result;
  result.positions = readings.size();
  result.iterations = found.iterations;
  result.converged = found.converged;
  result.condition = found.condition;
  // x = g A' (u - b') with u = (y - middle)/width: A_ij = g A'_ij / width_j, b = middle + width b'.
  Eigen::Index index = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j, ++index) {
      const double factor = gravity_m_s2 / scaled->width[static_cast<Eigen::Index>(j)];
      const double value = factor * found.p[index];
      const double spread = spread_of(index, factor);
      result.correction[i][j] = {value, {value - spread, value + spread}};
    }
  }
  for (std::size_t j = 0; j < 3; ++j, ++index) {
    const double width = scaled->width[static_cast<Eigen::Index>(j)];
    const double value = scaled->middle[static_cast<Eigen::Index>(j)] + width * found.p[index];
    const double spread = spread_of(index, width);
    result.bias[j] = {value, {value - spread, value + spread}};
  }
  result.residual_after = gravity_m_s2 * std::sqrt(found.square / static_cast<double>(readings.size()));
  result.residual_before = best_single_factor(readings, gravity_m_s2);
  if (!found.converged) {
    result.warnings.emplace_back("The search for the nine numbers did not converge.");
  }
  if (found.condition > 1e8) {
    result.warnings.emplace_back(
        "The positions do not tell the nine numbers apart; turn the sensor to more attitudes.");
  }
  return result;
}

}  // namespace driftlab
