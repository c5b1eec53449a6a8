#include "core/calibrate/six_position.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

constexpr double kAlong = 0.9;  // of its length: a truth along an axis

/// The line of one sensor: reading = coefficients . (x, y, z, 1), over those positions that are used.
struct Line {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< as the uncertainties of the means say
  double chi_square = 0.0;
  std::size_t readings = 0;
  std::size_t free = 0;
};

char axis_name(std::size_t axis) { return "xyz"[axis]; }

bool lies_along(const Triple& truth, std::size_t axis) {
  const double whole = length(truth);
  return whole > 0.0 && std::abs(truth[axis]) >= kAlong * whole;
}

Status check(std::span<const KnownPosition> positions) {
  for (const KnownPosition& position : positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(position.reading.mean[axis]) || !std::isfinite(position.truth[axis]) ||
          !(position.reading.sigma[axis] >= 0.0)) {
        return fail(ErrorCode::NonFinite, "A position of the test has a reading or a true value that is not finite.");
      }
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto any = [&](double sign) {
      return std::any_of(positions.begin(), positions.end(), [&](const KnownPosition& position) {
        return lies_along(position.truth, axis) && position.truth[axis] * sign > 0.0;
      });
    };
    if (!any(1.0) || !any(-1.0)) {
      return fail(ErrorCode::TooFewSamples,
                  std::string("The test needs a position with axis ") + axis_name(axis) + " up and one with it down.",
                  {{"axis", std::string(1, axis_name(axis))}});
    }
  }
  return {};
}

/// Weighted least squares of one sensor's readings. `columns`: which of (x, y, z, 1) are free.
Result<Line> fit_line(std::span<const KnownPosition> positions, std::size_t axis, bool misalignment) {
  std::vector<int> columns{static_cast<int>(axis), 3};
  if (misalignment) {
    columns = {0, 1, 2, 3};
  }
  std::vector<const KnownPosition*> used;
  for (const KnownPosition& position : positions) {
    if (misalignment || lies_along(position.truth, axis)) {
      used.push_back(&position);
    }
  }
  const auto rows = static_cast<Eigen::Index>(used.size());
  const auto width = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd design(rows, width);
  Eigen::VectorXd reading(rows);
  const bool weighted =
      std::all_of(used.begin(), used.end(), [&](const KnownPosition* p) { return p->reading.sigma[axis] > 0.0; });
  for (Eigen::Index i = 0; i < rows; ++i) {
    const KnownPosition& position = *used[static_cast<std::size_t>(i)];
    const double weight = weighted ? 1.0 / position.reading.sigma[axis] : 1.0;
    for (Eigen::Index k = 0; k < width; ++k) {
      const int column = columns[static_cast<std::size_t>(k)];
      design(i, k) = weight * (column == 3 ? 1.0 : position.truth[static_cast<std::size_t>(column)]);
    }
    reading[i] = weight * position.reading.mean[axis];
  }
  // Columns of comparable size, so that the rank does not depend on g or a rate in rad/s.
  const Eigen::VectorXd size = design.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = design * size.cwiseInverse().asDiagonal();
  const Eigen::VectorXd singular = singular_values(scaled);
  if (rows < width || !(singular[width - 1] > 1e-12 * singular[0])) {
    return fail(ErrorCode::TooFewSamples,
                "The positions do not determine the misalignments: true values in four directions not of one plane are "
                "needed.");
  }
  const Eigen::VectorXd solution = least_squares(scaled, reading);
  const Eigen::MatrixXd spread = inverse(scaled.transpose() * scaled);
  Line line;
  line.readings = used.size();
  line.free = columns.size();
  line.chi_square = (reading - scaled * solution).squaredNorm();
  for (Eigen::Index a = 0; a < width; ++a) {
    const int ka = columns[static_cast<std::size_t>(a)];
    line.value[ka] = solution[a] / size[a];
    for (Eigen::Index b = 0; b < width; ++b) {
      line.covariance(ka, columns[static_cast<std::size_t>(b)]) = spread(a, b) / (size[a] * size[b]);
    }
  }
  if (!weighted) {  // the scatter alone says how uncertain the readings are
    const double dof = static_cast<double>(line.readings - line.free);
    const double variance = dof > 0.0 ? line.chi_square / dof : std::numeric_limits<double>::infinity();
    line.covariance *= variance;
    line.chi_square = variance > 0.0 && std::isfinite(variance) ? dof : 0.0;
  }
  return line;
}

/// An interval without end where the variance is not known.
Estimate estimate(double value, double variance, double quantile) {
  if (!std::isfinite(variance)) {
    return {value, {}};
  }
  const double half = quantile * std::sqrt(std::max(variance, 0.0));
  return {value, {value - half, value + half}};
}

double residual(std::span<const KnownPosition> positions, const TriadLaw& law) {
  double sum = 0.0;
  for (const KnownPosition& position : positions) {
    const Triple corrected = law.correct(position.reading.mean);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double error = corrected[axis] - position.truth[axis];
      sum += error * error;
    }
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(positions.size())));
}

}  // namespace

Result<TriadCalibration> calibrate_six_positions(std::span<const KnownPosition> positions,
                                                 const SixPositionOptions& options) {
  if (auto status = check(positions); !status) {
    return fail(status.error());
  }
  std::array<Line, 3> lines;
  double chi_square = 0.0;
  double dof = 0.0;
  TriadCalibration result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto line = fit_line(positions, axis, options.misalignment);
    if (!line) {
      return fail(line.error());
    }
    lines[axis] = *line;
    chi_square += line->chi_square;
    dof += static_cast<double>(line->readings - line->free);
    result.readings += line->readings;
  }
  result.chi_square_per_dof = dof > 0.0 ? chi_square / dof : 0.0;
  const bool scattered = dof > 0.0 && result.chi_square_per_dof > 1.0;
  const double widen = scattered ? result.chi_square_per_dof : 1.0;
  const double quantile = scattered ? student_quantile(0.975, dof) : kNormal975;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Line& line = lines[axis];
    const auto own = static_cast<Eigen::Index>(axis);
    result.bias[axis] = estimate(line.value[3], widen * line.covariance(3, 3), quantile);
    result.scale_factor[axis] = estimate(line.value[own] - 1.0, widen * line.covariance(own, own), quantile);
    result.law.bias[axis] = line.value[3];
    result.law.matrix[axis][axis] = line.value[own];
    for (std::size_t other = 0; other < 3; ++other) {
      const auto j = static_cast<Eigen::Index>(other);
      if (options.misalignment && other != axis) {
        result.misalignment[axis][other] = estimate(line.value[j], widen * line.covariance(j, j), quantile);
        result.law.matrix[axis][other] = line.value[j];
      }
    }
  }
  result.residual_before = residual(positions, TriadLaw{});
  result.residual_after = residual(positions, result.law);
  return result;
}

}  // namespace driftlab
