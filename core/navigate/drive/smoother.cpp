#include "core/navigate/drive/smoother.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

/// h over all states.
Eigen::VectorXd dense_of(const WideMeasurement& measurement, Eigen::Index states) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(states);
  h.head<9>() = measurement.navigation.h;
  for (std::size_t i = 0; i < measurement.count; ++i) {
    h(9 + measurement.index[i]) += measurement.weight[i];
  }
  return h;
}

}  // namespace

void FilterTape::step(const Eigen::MatrixXd& transition) {
  order_.push_back({Kept::What::Step, steps_.size()});
  steps_.push_back(transition);
}

void FilterTape::measured(const Eigen::MatrixXd& covariance, std::span<const WideMeasurement> measurements) {
  Eigen::MatrixXd p = covariance;
  Eigen::VectorXd correction = Eigen::VectorXd::Zero(p.rows());
  for (const WideMeasurement& measurement : measurements) {
    Scalar kept;
    kept.h = dense_of(measurement, p.rows());
    const Eigen::VectorXd ph = p * kept.h;
    kept.variance = kept.h.dot(ph) + measurement.navigation.variance;
    kept.innovation = measurement.navigation.innovation - kept.h.dot(correction);
    kept.gain = ph / kept.variance;
    correction += kept.innovation * kept.gain;
    p -= kept.gain * ph.transpose();
    order_.push_back({Kept::What::Scalar, scalars_.size()});
    scalars_.push_back(std::move(kept));
  }
}

void FilterTape::point(double time_s, const NavigationState& state, const Eigen::MatrixXd& covariance) {
  order_.push_back({Kept::What::Point, points_.size()});
  points_.push_back({time_s, state, covariance.topRows(9)});
}

double FilterTape::last_point_s() const {
  return points_.empty() ? -std::numeric_limits<double>::infinity() : points_.back().time_s;
}

std::vector<FilterTape::Point> FilterTape::smoothed() const {
  if (points_.empty()) {
    return {};
  }
  const Eigen::Index n = points_.front().rows.cols();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  std::vector<Point> path(points_.size());
  for (auto kept = order_.rbegin(); kept != order_.rend(); ++kept) {
    switch (kept->what) {
      case Kept::What::Step: {
        const Eigen::MatrixXd& phi = steps_[kept->index];
        lambda = (phi.transpose() * lambda).eval();
        information = (phi.transpose() * information * phi).eval();
        break;
      }
      case Kept::What::Scalar: {
        const Scalar& m = scalars_[kept->index];
        lambda -= m.h * (m.gain.dot(lambda) + m.innovation / m.variance);
        // (I - K h^T)^T L (I - K h^T) = L - h (L K)^T - (L K) h^T + h (K^T L K) h^T
        const Eigen::VectorXd lk = information * m.gain;
        information += (m.gain.dot(lk) + 1.0 / m.variance) * m.h * m.h.transpose();
        information -= m.h * lk.transpose() + lk * m.h.transpose();
        break;
      }
      case Kept::What::Point: {
        const Filtered& at = points_[kept->index];
        Point& point = path[kept->index];
        const Eigen::Matrix<double, 9, 1> error = -at.rows * lambda;
        point.time_s = at.time_s;
        point.state = at.state;
        point.state.position_ecef_m += error.segment<3>(0);
        point.state.velocity_ecef_m_s += error.segment<3>(3);
        point.state.attitude = rotation(Vector3(error.segment<3>(6))) * at.state.attitude;
        const Eigen::Matrix<double, 9, 9> rest = at.rows.leftCols<9>() - at.rows * information * at.rows.transpose();
        point.covariance = 0.5 * (rest + rest.transpose());
        break;
      }
    }
  }
  return path;
}

std::vector<FilterTape::Point> smoothed_path(const PreparedDrive& prepared) {
  std::vector<FilterTape::Point> path;
  for (std::size_t part = 0; part < prepared.parts(); ++part) {
    FilterTape tape;
    FilterTask task;
    task.tape = &tape;
    (void)prepared.run(part, task);
    for (FilterTape::Point& point : tape.smoothed()) {
      // In the first seconds P and P Lambda P differ by less than they are rounded: what is known there is not.
      if (Eigen::LLT<Eigen::Matrix<double, 9, 9>>(point.covariance).info() != Eigen::Success) {
        continue;
      }
      path.push_back(std::move(point));
    }
  }
  return path;
}

Result<Drive> with_smoothed_reference(Drive drive, const FilterOptions& options) {
  const auto prepared = PreparedDrive::make(drive, options);
  if (!prepared) {
    return fail(prepared.error());
  }
  const auto path = smoothed_path(*prepared);
  if (path.size() < 8) {
    return fail(ErrorCode::TooFewSamples, "The drive has too few fixes to be smoothed.");
  }
  std::vector<ReferencePoint> reference;
  double square = 0.0;
  for (const FilterTape::Point& point : path) {
    if (!reference.empty() && point.time_s <= reference.back().time_s) {
      continue;
    }
    const Matrix3 to_ned = ned_axes(point.state.position_ecef_m).transpose();
    const Matrix3 horizontal = to_ned * point.covariance.topLeftCorner<3, 3>() * to_ned.transpose();
    square += std::max(0.5 * (horizontal(0, 0) + horizontal(1, 1)), 0.0);
    reference.push_back({point.time_s, point.state.position_ecef_m + point.state.attitude * options.lever_arm_m});
  }
  drive.document.reference.sd_m = std::sqrt(square / static_cast<double>(reference.size()));
  drive.document.reference.lever_arm_m = options.lever_arm_m;
  drive.reference = std::move(reference);
  drive.withheld_fixes = false;
  drive.facts.notes.emplace_back(
      "The reference is the filter's own path, smoothed over all fixes: what both get wrong alike does not show.");
  return drive;
}

}  // namespace driftlab::drive
