#include "core/navigate/navigation_filter.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// [u x] M.
Matrix3 crossed(const Vector3& u, const Matrix3& m) {
  Matrix3 out;
  out.row(0) = u.y() * m.row(2) - u.z() * m.row(1);
  out.row(1) = u.z() * m.row(0) - u.x() * m.row(2);
  out.row(2) = u.x() * m.row(1) - u.y() * m.row(0);
  return out;
}

/// Directions in which the integrals I1, I2, I3 of one axis's error enter (r, v, phi); see navigation_filter.hpp.
struct AxisEffect {
  Vector3 first = Vector3::Zero();   ///< of I1: on phi for a gyroscope, on v for an accelerometer
  Vector3 second = Vector3::Zero();  ///< of I2: on v, on r
  Vector3 third = Vector3::Zero();   ///< of I3: on r; accelerometers have none
  bool gyroscope = true;

  /// Column of a 9-row matrix for the weights of I1, I2, I3.
  [[nodiscard]] Eigen::Matrix<double, 9, 1> column(double w1, double w2, double w3) const {
    Eigen::Matrix<double, 9, 1> out;
    if (gyroscope) {
      out << third * w3, second * w2, first * w1;
    } else {
      out << second * w2, first * w1, Vector3::Zero();
    }
    return out;
  }
};

}  // namespace

NavigationFilter::NavigationFilter(const FilterDesign& design, const NavigationState& start)
    : design_(&design),
      strapdown_(start, design.dt_s()),
      covariance_(design.sensor_states()),
      sensors_(Eigen::VectorXd::Zero(design.sensor_states())) {
  const InitialUncertainty& initial = design.settings().initial;
  const Matrix3 axes = ned_axes(start.position_ecef_m);
  const auto rotated = [&](const Vector3& sd) -> Matrix3 {
    const Matrix3 full = axes * sd.cwiseAbs2().asDiagonal() * axes.transpose();
    return 0.5 * (full + full.transpose());
  };
  covariance_.navigation().block<3, 3>(0, 0) = rotated(initial.position_sd_m);
  covariance_.navigation().block<3, 3>(3, 3) = rotated(initial.velocity_sd_m_s);
  covariance_.navigation().block<3, 3>(6, 6) =
      rotated({initial.tilt_sd_rad, initial.tilt_sd_rad, initial.heading_sd_rad});
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    active_[c] = &design.channel(c, 0);
    const int first = design.first_state(c);
    for (int i = 0; i < active_[c]->states; ++i) {
      sensors_(first + i) = active_[c]->start(i);
      for (int j = 0; j < active_[c]->states; ++j) {
        covariance_.add_sensor(first + i, first + j, active_[c]->start_covariance(i, j));
      }
    }
  }
  const std::vector<double>& constants = design.settings().constants_sd;
  for (std::size_t k = 0; k < constants.size(); ++k) {
    const int own = design.first_constant() + static_cast<int>(k);
    covariance_.add_sensor(own, own, constants[k] * constants[k]);
  }
  if (const auto& constraint = design.settings().non_holonomic) {
    const double samples = 1.0 / (constraint->rate_hz * design.dt_s());
    constraint_samples_ = std::max(1, static_cast<int>(std::lround(samples)));
  }
}

void NavigationFilter::sample(const ImuSample& reading) {
  std::array<double, kImuChannels> corrected{};
  double* const x = sensors_.data();
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const ChannelDynamics& axis = *active_[c];
    double* const own = x + design_->first_state(c);
    double error = 0.0;
    for (int i = 0; i < axis.states; ++i) {
      error += axis.output(i) * own[i];
    }
    corrected[c] = reading[c] - error;
    if (axis.diagonal) {
      for (int i = 0; i < axis.states; ++i) {
        own[i] *= axis.sample_phi(i, i);
      }
    } else {
      const AxisVector before = Eigen::Map<const AxisVector>(own, axis.states);
      Eigen::Map<AxisVector>(own, axis.states).noalias() = axis.sample_phi * before;
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    readings_[c] += reading[c];
  }
  last_rate_ = {corrected[0], corrected[1], corrected[2]};
  const Vector3 before = strapdown_.state().velocity_ecef_m_s;
  const StrapdownStep step = strapdown_.advance(last_rate_, {corrected[3], corrected[4], corrected[5]});
  const double dt = design_->dt_s();
  last_acceleration_ = (strapdown_.state().velocity_ecef_m_s - before) / dt;
  // Integrals over the sample with C and C f constant in it.
  const Matrix3 c_dt = step.attitude_middle * dt;
  const Matrix3 before_turned = turned_;
  const Matrix3 gain = crossed(step.velocity_gained, before_turned + 0.5 * c_dt);
  forced_twice_ += dt * (forced_ + crossed(step.velocity_gained, 0.5 * before_turned + (1.0 / 6.0) * c_dt));
  forced_ += gain;
  turned_twice_ += dt * (before_turned + 0.5 * c_dt);
  turned_ += c_dt;
  position_ += dt * (velocity_ + 0.5 * step.velocity_gained);
  velocity_ += step.velocity_gained;
  ++pending_;
}

void NavigationFilter::advance(std::span<const ImuSample> readings) {
  for (const ImuSample& reading : readings) {
    sample(reading);
    if (pending_ == design_->settings().covariance_samples) {
      close_step();
    }
    if (constraint_samples_ > 0 && ++since_constraint_ == constraint_samples_) {
      since_constraint_ = 0;
      close_step();
      constrain();
    }
  }
}

void NavigationFilter::prepare(NavigationTransition& navigation, SensorTransition& sensors) const {
  const double t = pending_ * design_->dt_s();
  navigation.step_s = t;
  navigation.gravity_step = t * gravity_gradient(strapdown_.state().position_ecef_m);
  navigation.velocity = velocity_;
  navigation.position = position_;
  const auto stride = static_cast<std::size_t>(covariance_.stride());
  for (int constant = design_->first_constant(); constant < design_->sensor_states(); ++constant) {
    sensors.phi[static_cast<std::size_t>(constant)] = remembered(constant, t);
  }
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const auto k = static_cast<Eigen::Index>(c % 3);
    AxisEffect effect;
    effect.gyroscope = c < 3;
    // I1 = T, I2 = T^2/2, I3 = T^3/6 for a constant error: the sums below are what such an error of 1 does.
    effect.first = -turned_.col(k) / t;
    if (effect.gyroscope) {
      effect.second = forced_.col(k) * (2.0 / (t * t));
      effect.third = forced_twice_.col(k) * (6.0 / (t * t * t));
    } else {
      effect.second = -turned_twice_.col(k) * (2.0 / (t * t));
    }
    const ChannelStep& step = active_[c]->steps[static_cast<std::size_t>(pending_) - 1];
    for (int i = 0; i < active_[c]->states; ++i) {
      const auto column = static_cast<std::size_t>(design_->first_state(c)) + static_cast<std::size_t>(i);
      const auto gain = effect.column(step.gain(0, i), step.gain(1, i), step.gain(2, i));
      const auto noise = effect.column(step.cross_noise(0, i), step.cross_noise(1, i), step.cross_noise(2, i));
      for (std::size_t row = 0; row < 9; ++row) {
        sensors.gain[row * stride + column] = gain(static_cast<Eigen::Index>(row));
        sensors.cross_noise[row * stride + column] = noise(static_cast<Eigen::Index>(row));
      }
      sensors.phi[column] = active_[c]->diagonal ? step.phi(i, i) : 1.0;
    }
    // L q L^T with L the three columns; two products of small matrices.
    Eigen::Matrix<double, 9, 3> columns;
    columns << effect.column(1.0, 0.0, 0.0), effect.column(0.0, 1.0, 0.0), effect.column(0.0, 0.0, 1.0);
    Matrix3 integral_noise = step.integral_noise;
    if (extra_noise_[c] > 0.0) {
      integral_noise +=
          extra_noise_[c] * design_->unit_white().steps[static_cast<std::size_t>(pending_) - 1].integral_noise;
    }
    const Eigen::Matrix<double, 9, 3> weighted = columns.lazyProduct(integral_noise);
    for (int i = 0; i < 9; ++i) {
      for (int j = i; j < 9; ++j) {
        sensors.noise(i, j) += weighted.row(i).dot(columns.row(j));
      }
    }
  }
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < i; ++j) {
      sensors.noise(i, j) = sensors.noise(j, i);
    }
  }
}

void NavigationFilter::close_step() {
  if (pending_ == 0) {
    return;
  }
  NavigationTransition navigation;
  SensorTransition sensors;
  prepare(navigation, sensors);
  covariance_.propagate(navigation, sensors);
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const ChannelStep& step = active_[c]->steps[static_cast<std::size_t>(pending_) - 1];
    const int first = design_->first_state(c);
    if (!active_[c]->diagonal) {
      covariance_.mix(first, Eigen::MatrixXd(step.phi));
    }
    for (int i = 0; i < active_[c]->states; ++i) {
      for (int j = 0; j < active_[c]->states; ++j) {
        covariance_.add_sensor(first + i, first + j, step.state_noise(i, j));
      }
    }
  }
  forget_constants();
  covariance_.add_noise(sensors);
  choose_bands();
  pending_ = 0;
  turned_.setZero();
  turned_twice_.setZero();
  forced_.setZero();
  forced_twice_.setZero();
  velocity_.setZero();
  position_.setZero();
  readings_ = {};
}

double NavigationFilter::remembered(int constant, double time_s) const {
  const std::vector<double>& tau = design_->settings().constants_tau_s;
  const auto k = static_cast<std::size_t>(constant - design_->first_constant());
  return tau.empty() || !(tau[k] > 0.0) ? 1.0 : std::exp(-time_s / tau[k]);
}

void NavigationFilter::forget_constants() {
  const FilterSettings& settings = design_->settings();
  for (std::size_t k = 0; k < settings.constants_tau_s.size(); ++k) {
    const int own = design_->first_constant() + static_cast<int>(k);
    const double phi = remembered(own, pending_ * design_->dt_s());
    sensors_(own) *= phi;
    covariance_.add_sensor(own, own, settings.constants_sd[k] * settings.constants_sd[k] * (1.0 - phi * phi));
  }
}

void NavigationFilter::set_extra_noise(const std::array<double, kImuChannels>& squared_density) {
  if (squared_density != extra_noise_) {
    close_step();
    extra_noise_ = squared_density;
  }
}

void NavigationFilter::choose_bands() {
  for (std::size_t c = 0; c < 3; ++c) {
    const ModelSchedule& schedule = design_->settings().imu.axes[c].processes;
    if (schedule.size() > 1) {
      bands_[c] = schedule.next_band(bands_[c], readings_[c] / pending_);
      active_[c] = &design_->channel(c, bands_[c]);
    }
  }
}

const ErrorCovariance& NavigationFilter::covariance() {
  close_step();
  return covariance_;
}

void NavigationFilter::update(const GnssFix& fix) {
  close_step();
  const FilterSettings& settings = design_->settings();
  const NavigationState& state = strapdown_.state();
  const Matrix3 axes = ned_axes(state.position_ecef_m);
  const double late = settings.compensate_latency ? fix.arrival_s - fix.validity_s : 0.0;
  const Vector3 arm = strapdown_.attitude() * settings.lever_arm_m;
  const Vector3 body_rate = last_rate_ - strapdown_.attitude().transpose() * earth_rate();
  const Vector3 arm_velocity = strapdown_.attitude() * body_rate.cross(settings.lever_arm_m);
  // The antenna at the moment the fix describes, to second order in the latency.
  const Vector3 antenna = state.position_ecef_m + arm - late * (state.velocity_ecef_m_s + arm_velocity) +
                          (0.5 * late * late) * last_acceleration_;
  const Vector3 position_gap = fix.position_ecef_m - antenna;
  ErrorCovariance::State correction = ErrorCovariance::State::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 axis = axes.col(k);
    ScalarMeasurement measurement;
    measurement.h << axis, -late * axis, arm.cross(axis);
    measurement.innovation = axis.dot(position_gap);
    measurement.variance = fix.position_sd_m(k) * fix.position_sd_m(k);
    covariance_.update(measurement, correction);
  }
  if (settings.use_velocity && fix.velocity_ecef_m_s) {
    const Vector3 velocity_gap =
        *fix.velocity_ecef_m_s - (state.velocity_ecef_m_s + arm_velocity - late * last_acceleration_);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 axis = axes.col(k);
      ScalarMeasurement measurement;
      measurement.h << Vector3::Zero(), axis, arm_velocity.cross(axis);
      measurement.innovation = axis.dot(velocity_gap);
      measurement.variance = fix.velocity_sd_m_s(k) * fix.velocity_sd_m_s(k);
      covariance_.update(measurement, correction);
    }
  }
  apply(correction);
}

void NavigationFilter::measure(std::span<const WideMeasurement> measurements, std::span<ScalarInnovation> innovations) {
  close_step();
  ErrorCovariance::State correction = ErrorCovariance::State::Zero();
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const ScalarInnovation innovation = covariance_.update(measurements[i], correction);
    if (!innovations.empty()) {
      innovations[i] = innovation;
    }
  }
  apply(correction);
}

void NavigationFilter::constrain() {
  const Vector3 velocity = strapdown_.state().velocity_ecef_m_s;
  const auto& constraint = design_->settings().non_holonomic;
  const double sd = constraint ? constraint->sd_m_s : 1.0;
  ErrorCovariance::State correction = ErrorCovariance::State::Zero();
  for (Eigen::Index k = 1; k < 3; ++k) {  // right and down
    const Vector3 axis = strapdown_.attitude().col(k);
    ScalarMeasurement measurement;
    measurement.h << Vector3::Zero(), axis, axis.cross(velocity);
    measurement.innovation = -axis.dot(velocity);
    measurement.variance = sd * sd;
    covariance_.update(measurement, correction);
  }
  apply(correction);
}

void NavigationFilter::apply(const ErrorCovariance::State& correction) {
  strapdown_.correct(correction.segment<3>(0), correction.segment<3>(3), correction.segment<3>(6));
  sensors_ += correction.segment(9, design_->sensor_states());
}

Eigen::MatrixXd NavigationFilter::pending_transition() const {
  NavigationTransition navigation;
  SensorTransition sensors;
  prepare(navigation, sensors);
  const Eigen::Index n = 9 + design_->sensor_states();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(n, n);
  const double t = navigation.step_s;
  whole.block<3, 3>(0, 3) = t * Matrix3::Identity();
  whole.block<3, 3>(0, 6) = -cross_matrix(navigation.position);
  whole.block<3, 3>(3, 0) = navigation.gravity_step;
  whole.block<3, 3>(3, 3) -= 2.0 * t * cross_matrix(earth_rate());
  whole.block<3, 3>(3, 6) = -cross_matrix(navigation.velocity);
  whole.block<3, 3>(6, 6) -= t * cross_matrix(earth_rate());
  for (Eigen::Index j = 0; j < design_->sensor_states(); ++j) {
    for (Eigen::Index i = 0; i < 9; ++i) {
      whole(i, 9 + j) = sensors.gain[static_cast<std::size_t>(i * covariance_.stride() + j)];
    }
  }
  for (int constant = design_->first_constant(); constant < design_->sensor_states(); ++constant) {
    whole(9 + constant, 9 + constant) = remembered(constant, t);
  }
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const Eigen::Index first = 9 + design_->first_state(c);
    const Eigen::Index count = active_[c]->states;
    whole.block(first, first, count, count) = active_[c]->steps[static_cast<std::size_t>(pending_) - 1].phi;
  }
  return whole;
}

NavigationError error_of(const NavigationState& estimate, const NavigationState& truth) {
  const Matrix3 to_ned = ned_axes(truth.position_ecef_m).transpose();
  NavigationError error;
  error.position_ned_m = to_ned * (estimate.position_ecef_m - truth.position_ecef_m);
  error.velocity_ned_m_s = to_ned * (estimate.velocity_ecef_m_s - truth.velocity_ecef_m_s);
  error.attitude_rad = to_ned * rotation_vector(estimate.attitude * truth.attitude.conjugate());
  return error;
}

}  // namespace driftlab
