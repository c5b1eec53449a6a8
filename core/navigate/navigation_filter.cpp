#include "core/navigate/navigation_filter.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// [u x] M.
inline Matrix3 crossed(const Vector3& u, const Matrix3& m) {
  Matrix3 out;
  out.row(0) = u.y() * m.row(2) - u.z() * m.row(1);
  out.row(1) = u.z() * m.row(0) - u.x() * m.row(2);
  out.row(2) = u.x() * m.row(1) - u.y() * m.row(0);
  return out;
}

/// U diag(d) V^T.
Matrix3 weighted(const Matrix3& u, const Vector3& d, const Matrix3& v) {
  return (u.array().rowwise() * d.transpose().array()).matrix().lazyProduct(v.transpose());
}

}  // namespace

/// Directions in which the integrals I1, I2, I3 of the axes' errors enter (r, v, phi), one column an axis; see
/// navigation_filter.hpp. I1 = T, I2 = T^2/2, I3 = T^3/6 for a constant error: the sums over a step are what such an
/// error of 1 does.
struct NavigationFilter::TriadEffect {
  Matrix3 first = Matrix3::Zero();   ///< of I1: on phi for gyroscopes, on v for accelerometers
  Matrix3 second = Matrix3::Zero();  ///< of I2: on v, on r
  Matrix3 third = Matrix3::Zero();   ///< of I3: on r; accelerometers have none
};

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
  for (int constant = design_->first_constant(); constant < design_->sensor_states(); ++constant) {
    sensors.phi[static_cast<std::size_t>(constant)] = remembered(constant, t);
  }
  const Matrix3 turned = turned_ * (-1.0 / t);
  const TriadEffect gyroscopes{turned, forced_ * (2.0 / (t * t)), forced_twice_ * (6.0 / (t * t * t))};
  const TriadEffect accelerometers{turned, turned_twice_ * (-2.0 / (t * t))};
  const auto stride = static_cast<std::size_t>(covariance_.stride());
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const ChannelStep& step = active_[c]->steps[static_cast<std::size_t>(pending_) - 1];
    const auto k = static_cast<Eigen::Index>(c % 3);
    for (int i = 0; i < active_[c]->states; ++i) {
      const auto column = static_cast<std::size_t>(design_->first_state(c)) + static_cast<std::size_t>(i);
      const auto enter = [&](const AxisGains& weight, double* rows) {
        for (Eigen::Index row = 0; row < 3; ++row) {
          double* const of_r = rows + static_cast<std::size_t>(row) * stride + column;
          if (c < 3) {
            of_r[0] = gyroscopes.third(row, k) * weight(2, i);
            of_r[3 * stride] = gyroscopes.second(row, k) * weight(1, i);
            of_r[6 * stride] = gyroscopes.first(row, k) * weight(0, i);
          } else {
            of_r[0] = accelerometers.second(row, k) * weight(1, i);
            of_r[3 * stride] = accelerometers.first(row, k) * weight(0, i);
          }
        }
      };
      enter(step.gain, sensors.gain.data());
      enter(step.cross_noise, sensors.cross_noise.data());
      sensors.phi[column] = active_[c]->diagonal ? step.phi(i, i) : 1.0;
    }
  }
  prepare_noise(gyroscopes, accelerometers, sensors.noise);
}

/// L q L^T summed over the axes, q the covariance of an axis's integrals: with q(a, b) of the three axes of a triad on
/// a diagonal, the blocks of (r, v, phi) are products of three matrices of 3 x 3.
void NavigationFilter::prepare_noise(const TriadEffect& gyroscopes, const TriadEffect& accelerometers,
                                     ErrorCovariance::Navigation& noise) const {
  std::array<Matrix3, kImuChannels> q;
  const std::size_t last = static_cast<std::size_t>(pending_) - 1;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    q[c] = active_[c]->steps[last].integral_noise;
    if (extra_noise_[c] > 0.0) {
      q[c] += extra_noise_[c] * design_->unit_white().steps[last].integral_noise;
    }
  }
  const auto of_gyroscopes = [&](int a, int b) { return Vector3(q[0](a, b), q[1](a, b), q[2](a, b)); };
  const auto of_accelerometers = [&](int a, int b) { return Vector3(q[3](a, b), q[4](a, b), q[5](a, b)); };
  const TriadEffect& g = gyroscopes;
  const TriadEffect& f = accelerometers;
  noise.block<3, 3>(0, 0) =
      weighted(g.third, of_gyroscopes(2, 2), g.third) + weighted(f.second, of_accelerometers(1, 1), f.second);
  noise.block<3, 3>(0, 3) =
      weighted(g.third, of_gyroscopes(2, 1), g.second) + weighted(f.second, of_accelerometers(1, 0), f.first);
  noise.block<3, 3>(0, 6) = weighted(g.third, of_gyroscopes(2, 0), g.first);
  noise.block<3, 3>(3, 3) =
      weighted(g.second, of_gyroscopes(1, 1), g.second) + weighted(f.first, of_accelerometers(0, 0), f.first);
  noise.block<3, 3>(3, 6) = weighted(g.second, of_gyroscopes(1, 0), g.first);
  noise.block<3, 3>(6, 6) = weighted(g.first, of_gyroscopes(0, 0), g.first);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < i; ++j) {
      noise(i, j) = noise(j, i);
    }
  }
}

void NavigationFilter::close_step() {
  if (pending_ == 0) {
    return;
  }
  NavigationTransition navigation;
  prepare(navigation, step_);
  covariance_.propagate(navigation, step_);
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
  covariance_.add_noise(step_);
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
