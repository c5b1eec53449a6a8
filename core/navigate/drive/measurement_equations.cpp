#include "core/navigate/drive/measurement_equations.hpp"

#include "core/navigate/drive/vibration.hpp"
#include "core/signal/angle.hpp"

namespace driftlab::drive {
namespace {

constexpr double kRestSd = 0.02;                ///< [m/s]
constexpr double kRestTurnSd = 0.05 * kDegree;  ///< [rad/s]: what a vehicle turns on its springs, over a second

}  // namespace

Constants constants_of(const FilterOptions& options) {
  Constants all;
  for (const EstimatedConstant& constant : options.constants) {
    all.sd.push_back(constant.sd);
    all.tau_s.push_back(0.0);
  }
  for (Eigen::Index k = 0; k < 3 && !options.coloured.none(); ++k) {
    all.sd.push_back(options.coloured.sd_m()(k));
    all.tau_s.push_back(options.coloured.tau_s);
  }
  return all;
}

FilterOptions at_estimates(const FilterOptions& options, const NavigationFilter& filter, int first_constant) {
  FilterOptions present = options;
  for (std::size_t k = 0; k < options.constants.size(); ++k) {
    options.constants[k].turn(present, filter.sensor_states()(first_constant + static_cast<int>(k)));
  }
  return present;
}

std::array<WideMeasurement, 3> position_equations(const FilterMoment& at, const Fix& fix, double late_s) {
  const NavigationState& state = at.filter.state();
  const Matrix3& attitude = at.filter.attitude();
  const Matrix3 axes = ned_axes(state.position_ecef_m);
  const Vector3& own_arm = at.options.lever_arm_m;
  const Vector3 turned = attitude * own_arm;
  const Vector3 arm_velocity = attitude * at.body_rate.cross(own_arm);
  const Vector3 antenna = state.position_ecef_m + turned - late_s * (state.velocity_ecef_m_s + arm_velocity) +
                          (0.5 * late_s * late_s) * at.filter.last_acceleration();
  Vector3 gap = fix.position_ecef_m - antenna;
  const int lasting = at.first_constant + static_cast<int>(at.options.constants.size());
  const bool lasts = !at.options.coloured.none();
  for (int k = 0; lasts && k < 3; ++k) {
    gap -= at.filter.sensor_states()(lasting + k) * axes.col(k);
  }
  std::array<WideMeasurement, 3> measurements;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 axis = axes.col(k);
    WideMeasurement& m = measurements[static_cast<std::size_t>(k)];
    m.navigation.h << axis, -late_s * axis, turned.cross(axis);
    m.navigation.innovation = axis.dot(gap);
    m.navigation.variance = fix.position_sd_m(k) * fix.position_sd_m(k);
    if (lasts) {
      m.add(lasting + static_cast<int>(k), 1.0);
    }
  }
  return measurements;
}

std::array<WideMeasurement, 3> velocity_equations(const FilterMoment& at, const Vector3& velocity_ned_m_s,
                                                  const Vector3& sd_m_s, double late_s, const Vector3& more_body_m_s) {
  const NavigationState& state = at.filter.state();
  const Matrix3& attitude = at.filter.attitude();
  const Matrix3 axes = ned_axes(state.position_ecef_m);
  const Vector3 beside = attitude * (at.body_rate.cross(at.options.lever_arm_m) + more_body_m_s);
  const Vector3 gap =
      axes * velocity_ned_m_s - (state.velocity_ecef_m_s + beside - late_s * at.filter.last_acceleration());
  std::array<WideMeasurement, 3> measurements;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 axis = axes.col(k);
    WideMeasurement& m = measurements[static_cast<std::size_t>(k)];
    m.navigation.h << Vector3::Zero(), axis, beside.cross(axis);
    m.navigation.innovation = axis.dot(gap);
    m.navigation.variance = sd_m_s(k) * sd_m_s(k);
  }
  return measurements;
}

std::array<WideMeasurement, 2> constraint_equations(const FilterMoment& at, const Constraint& constraint,
                                                    const std::array<double, 2>& slip) {
  const auto& [rate_hz, sd_m_s, yaw, pitch, axle] = constraint;
  const Matrix3& attitude = at.filter.attitude();
  const Vector3 v = at.filter.state().velocity_ecef_m_s;
  const Vector3 body = attitude.transpose() * v;
  const Vector3& rate = at.body_rate;
  std::array<WideMeasurement, 2> measurements;
  const Vector3 right = attitude.col(1) - yaw * attitude.col(0);
  const Vector3 down = attitude.col(2) + pitch * attitude.col(0);
  measurements[0].navigation.h << Vector3::Zero(), right, right.cross(v);
  measurements[0].navigation.innovation = slip[0] - (body.y() - yaw * body.x() + axle * rate.z());
  measurements[1].navigation.h << Vector3::Zero(), down, down.cross(v);
  measurements[1].navigation.innovation = slip[1] - (body.z() + pitch * body.x() - axle * rate.y());
  for (WideMeasurement& m : measurements) {
    m.navigation.variance = sd_m_s * sd_m_s;
  }
  return measurements;
}

std::array<WideMeasurement, 3> rest_equations(const FilterMoment& at) {
  const NavigationState& state = at.filter.state();
  const Matrix3 axes = ned_axes(state.position_ecef_m);
  std::array<WideMeasurement, 3> measurements;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 axis = axes.col(k);
    WideMeasurement& m = measurements[static_cast<std::size_t>(k)];
    m.navigation.h << Vector3::Zero(), axis, Vector3::Zero();
    m.navigation.innovation = -axis.dot(state.velocity_ecef_m_s);
    m.navigation.variance = kRestSd * kRestSd;
  }
  return measurements;
}

std::array<WideMeasurement, 1> no_turn_equations(const FilterMoment& at, const FilterDesign& design, double mean_rate,
                                                 double seconds) {
  constexpr std::size_t kDown = 2;  // of the gyroscope's channels
  const ChannelDynamics& axis = design.channel(kDown, at.filter.band(kDown));
  const int first = design.first_state(kDown);
  const Vector3 earth = at.filter.attitude().transpose() * earth_rate();
  std::array<WideMeasurement, 1> measurement;
  WideMeasurement& m = measurement[0];
  double believed = 0.0;
  for (int k = 0; k < axis.states; ++k) {
    believed += axis.output(k) * at.filter.sensor_states()(first + k);
    m.add(first + k, axis.output(k));
  }
  m.navigation.h.setZero();
  m.navigation.innovation = mean_rate - earth.z() - believed;
  m.navigation.variance = kRestTurnSd * kRestTurnSd + white_square_of(design.settings().imu.axes[kDown]) / seconds;
  return measurement;
}

std::array<WideMeasurement, 1> odometer_equations(const FilterMoment& at, const OdometerSource& source,
                                                  double speed_m_s) {
  const Matrix3& attitude = at.filter.attitude();
  const Vector3 v = at.filter.state().velocity_ecef_m_s;
  const Vector3 arm_velocity = at.body_rate.cross(source.lever_arm_m);
  const double speed = (attitude.transpose() * v).x() + arm_velocity.x();
  const double scale = 1.0 + at.options.odometer_scale;
  std::array<WideMeasurement, 1> measurement;
  WideMeasurement& m = measurement[0];
  const Vector3 forward = scale * attitude.col(0);
  m.navigation.h << Vector3::Zero(), forward, forward.cross(v);
  m.navigation.innovation = speed_m_s - scale * speed;
  m.navigation.variance = source.sd_m_s * source.sd_m_s;
  return measurement;
}

}  // namespace driftlab::drive
