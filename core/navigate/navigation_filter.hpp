#pragma once
/// A loosely coupled navigation filter: strapdown mechanisation and a closed-loop error-state Kalman filter.
///
/// State: error of position, velocity and attitude in e (true = estimate + error; true C = (I + [phi x]) C), and per
/// sensing axis a constant bias and the states of the axis's error model (Gauss-Markov, random walk, drift, sinusoid,
/// quantization: whatever has a state space). With w~ = w + e the reading,
///   phi' = -w_ie x phi - C e_w,   dv' = -[C f x] phi + G dr - 2 w_ie x dv - C e_f,   dr' = dv.
///
/// Discretisation. The mechanisation runs at the sensors' rate; over a step of up to `covariance_samples` samples it
/// sums A = int C, W = int [C f x] A and their integrals, so that the transition holds the turning of the body and of
/// the force within the step; sensor errors and all process noise come from core/navigate/channel_dynamics.hpp, which
/// is exact for any step length. What is left out is of order (w_ie T)^2 and the change of C f against e^(-beta t)
/// within a step. tests/unit/navigate/navigation_filter_test.cpp compares the transition with differences of the
/// mechanisation, and steps of 10 samples with steps of 1.
///
/// Updates are scalar, in n axes, in Joseph's form; corrections are fed back at once. A schedule's band follows the
/// mean reading over the step before.
///
/// One million samples a second and more per core; no allocation after construction. Not thread safe: one per thread.
#include "core/navigate/channel_dynamics.hpp"
#include "core/navigate/error_covariance.hpp"
#include "core/navigate/gnss_simulator.hpp"
#include "core/navigate/strapdown.hpp"

#include <memory>
#include <optional>
#include <span>

namespace driftlab {

/// A road vehicle moves along its nose: lateral and vertical body velocity are measured as 0.
struct NonHolonomic {
  double rate_hz = 10.0;
  double sd_m_s = 0.2;
};

/// Standard deviations of the first estimate, north, east, down.
struct InitialUncertainty {
  Vector3 position_sd_m{2.5, 2.5, 4.0};
  Vector3 velocity_sd_m_s{0.1, 0.1, 0.2};
  double tilt_sd_rad = 0.0175;
  double heading_sd_rad = 0.0524;
};

struct FilterSettings {
  ImuModel imu;
  InitialUncertainty initial;
  bool use_velocity = true;
  /// Antenna from the inertial unit, body axes.
  Vector3 lever_arm_m = Vector3::Zero();
  /// Predicts a late fix for the moment it describes.
  bool compensate_latency = true;
  std::optional<NonHolonomic> non_holonomic;
  /// Standard deviations of constants that measurements of `measure` depend on and that are estimated beside the sensor
  /// errors: an arm, a mounting angle, a scale factor. They stand behind the sensor states.
  std::vector<double> constants_sd;
  /// Correlation times [s] of these where they are Gauss-Markov processes rather than constants, 0 for a constant;
  /// empty, or as many as there are.
  std::vector<double> constants_tau_s = {};
  int covariance_samples = 10;  ///< 1 to 100
};

/// What all filters of one kind share: settings and the dynamics of every axis in every band. Immutable.
class FilterDesign {
 public:
  /// Errors: those of make_channel_dynamics; LimitExceeded (more than 64 sensor states); InvalidArgument (settings).
  /// A schedule's first band speaks for all of them, which hold the same kinds of processes.
  [[nodiscard]] static Status check(const FilterSettings& settings, double dt_s);
  [[nodiscard]] static Result<FilterDesign> make(const FilterSettings& settings, double dt_s);

  [[nodiscard]] const FilterSettings& settings() const { return settings_; }
  [[nodiscard]] double dt_s() const { return dt_s_; }
  /// Constants of the settings included.
  [[nodiscard]] int sensor_states() const { return sensor_states_; }
  /// Where the constants of the settings stand among the sensor states.
  [[nodiscard]] int first_constant() const { return sensor_states_ - static_cast<int>(settings_.constants_sd.size()); }
  [[nodiscard]] int first_state(std::size_t channel) const { return first_[channel]; }
  [[nodiscard]] const ChannelDynamics& channel(std::size_t channel, std::size_t band) const {
    return channels_[channel][band];
  }
  /// Of white noise of density 1.
  [[nodiscard]] const ChannelDynamics& unit_white() const { return unit_white_; }

 private:
  FilterSettings settings_;
  double dt_s_ = 0.0;
  int sensor_states_ = 0;
  std::array<int, kImuChannels> first_{};
  std::array<std::vector<ChannelDynamics>, kImuChannels> channels_;
  ChannelDynamics unit_white_;
};

class NavigationFilter {
 public:
  /// `design` must outlive the filter.
  NavigationFilter(const FilterDesign& design, const NavigationState& start);

  /// Runs the mechanisation over `readings`; covariance and constraints step on the way.
  void advance(std::span<const ImuSample> readings);
  /// White noise beyond that of the model from here on: squared densities by axis [(rad/s)^2/Hz, (m/s^2)^2/Hz].
  void set_extra_noise(const std::array<double, kImuChannels>& squared_density);
  /// A fix that arrives now. Its position, and its velocity where it has one and the settings use it.
  void update(const GnssFix& fix);
  /// Any measurements of this moment, linearised by the caller at the present estimate, one after the other; what all
  /// of them say is fed back at once. `innovations`, of the same length or empty, gets what each brought.
  void measure(std::span<const WideMeasurement> measurements, std::span<ScalarInnovation> innovations = {});
  /// The rate that the last reading gave, sensor errors taken off [rad/s], body axes.
  [[nodiscard]] const Vector3& last_rate() const { return last_rate_; }
  /// The acceleration over the last sample [m/s^2] in e.
  [[nodiscard]] const Vector3& last_acceleration() const { return last_acceleration_; }
  /// b -> e.
  [[nodiscard]] const Matrix3& attitude() const { return strapdown_.attitude(); }

  [[nodiscard]] const NavigationState& state() const { return strapdown_.state(); }
  /// Expected sensor states, in the order of the design.
  [[nodiscard]] const Eigen::VectorXd& sensor_states() const { return sensors_; }
  /// Covariance of the errors, up to date at this sample.
  [[nodiscard]] const ErrorCovariance& covariance();
  [[nodiscard]] std::size_t band(std::size_t channel) const { return bands_[channel]; }
  /// The transition that the next `covariance()` will apply, as a dense matrix. Only while a step is
  /// open.
  [[nodiscard]] Eigen::MatrixXd pending_transition() const;

 private:
  struct TriadEffect;
  void sample(const ImuSample& reading);
  void close_step();
  /// Writes the transition of the open step; entries that no model has are left as they are, 0.
  void prepare(NavigationTransition& navigation, SensorTransition& sensors) const;
  void prepare_noise(const TriadEffect& gyroscopes, const TriadEffect& accelerometers,
                     ErrorCovariance::Navigation& noise) const;
  void apply(const ErrorCovariance::State& correction);
  void constrain();
  void choose_bands();
  /// What is left of a constant of the settings after a time: 1 where it has no correlation time.
  [[nodiscard]] double remembered(int constant, double time_s) const;
  void forget_constants();

  const FilterDesign* design_;
  Strapdown strapdown_;
  ErrorCovariance covariance_;
  Eigen::VectorXd sensors_;
  SensorTransition step_;  ///< work space: what one step has written the next overwrites
  std::array<std::size_t, kImuChannels> bands_{};
  std::array<const ChannelDynamics*, kImuChannels> active_{};
  Vector3 last_rate_ = Vector3::Zero();
  Vector3 last_acceleration_ = Vector3::Zero();
  std::array<double, kImuChannels> extra_noise_{};
  int constraint_samples_ = 0;  ///< between constraints; 0: none
  int since_constraint_ = 0;

  // Sums over the open step.
  int pending_ = 0;
  Matrix3 turned_ = Matrix3::Zero();        ///< A = int C
  Matrix3 turned_twice_ = Matrix3::Zero();  ///< int A
  Matrix3 forced_ = Matrix3::Zero();        ///< W = int [C f x] A
  Matrix3 forced_twice_ = Matrix3::Zero();  ///< int W
  Vector3 velocity_ = Vector3::Zero();      ///< V = int C f
  Vector3 position_ = Vector3::Zero();      ///< int V
  std::array<double, 3> readings_{};        ///< sums of the gyro readings
};

/// Errors of an estimate in n axes.
struct NavigationError {
  Vector3 position_ned_m;
  Vector3 velocity_ned_m_s;
  Vector3 attitude_rad;  ///< rotation vector in n: x and y are tilt, z is heading
};

/// Estimate minus truth.
[[nodiscard]] NavigationError error_of(const NavigationState& estimate, const NavigationState& truth);

}  // namespace driftlab
