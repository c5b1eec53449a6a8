#pragma once
/// Covariance of the filter's error state, stored by what its structure allows to skip.
///
/// States: position, velocity and attitude error in e (9), then the sensor states. Over a step
///   x_n' = F x_n + B x_s + noise,   x_s' = D x_s + noise,
/// with D block diagonal (one block per axis, mostly a diagonal), F nearly the identity, and B filled. P is kept as the
/// blocks P_nn (9 x 9), P_ns (9 x m) and P_ss (m x m); a step costs about 9 m^2 + 100 m multiplications instead of the
/// 2 n^3 of the textbook. Every entry and its mirror image are computed by the same operations, so P stays symmetric to
/// the bit. Updates are scalar and in Joseph's form, (I - k h^T) P (I - k h^T)^T + R k k^T, computed as the two updates
/// of rank one that it amounts to (Bierman, Factorization Methods for Discrete Sequential Estimation, 1977). After a
/// measurement far more accurate than the state was known, the variance along h is then R despite rounding, and no
/// eigenvalue of P is below zero by more than rounding. With the form multiplied out, as
/// P - k (P h)^T - (P h) k^T + s k k^T, neither holds (tests/unit/navigate/error_covariance_test.cpp).
#include "core/navigate/earth.hpp"

#include <array>

namespace driftlab {

inline constexpr int kNavigationStates = 9;
inline constexpr int kMaxSensorStates = 64;
inline constexpr std::size_t kSensorRoom = kMaxSensorStates;  ///< the same as a size

/// The parts of a step that are not in the axis models. Rows r, v, phi of F:
///   r' = r + T v - [V2 x] phi,  v' = (I - 2 [w_ie x] T) v + G T r - [V x] phi,  phi' = (I - [w_ie x] T) phi.
struct NavigationTransition {
  double step_s = 0.0;
  Matrix3 gravity_step = Matrix3::Zero();  ///< gravity gradient times T
  Vector3 velocity = Vector3::Zero();      ///< V: integral of the force in e
  Vector3 position = Vector3::Zero();      ///< V2: integral of V
};

/// Work space of one step, laid out for vector units: rows of `stride` doubles, the unused ones 0.
struct SensorTransition {
  alignas(32) std::array<double, 9 * kSensorRoom> gain{};         ///< B
  alignas(32) std::array<double, 9 * kSensorRoom> cross_noise{};  ///< covariance of navigation with sensor noise
  alignas(32) std::array<double, kSensorRoom> phi{};              ///< diagonal of D
  Eigen::Matrix<double, 9, 9> noise = Eigen::Matrix<double, 9, 9>::Zero();
};

/// One scalar measurement: innovation = h . (navigation error) + noise.
struct ScalarMeasurement {
  Eigen::Matrix<double, 9, 1> h = Eigen::Matrix<double, 9, 1>::Zero();
  double innovation = 0.0;
  double variance = 0.0;
};

/// One that depends on sensor states too: innovation = h . (navigation error) + sum weight[i] (sensor state index[i]) +
/// noise.
struct WideMeasurement {
  static constexpr std::size_t kMost = 24;
  ScalarMeasurement navigation;
  std::size_t count = 0;  ///< sensor states that take part
  std::array<int, kMost> index{};
  std::array<double, kMost> weight{};
  void add(int state, double factor) {
    index[count] = state;
    weight[count++] = factor;
  }
};

/// Innovation of a scalar measurement, given the earlier measurements of the same moment, and its variance.
struct ScalarInnovation {
  double value = 0.0;
  double variance = 0.0;
};

class ErrorCovariance {
 public:
  using Navigation = Eigen::Matrix<double, 9, 9>;
  using State = Eigen::Matrix<double, 9 + kMaxSensorStates, 1>;

  /// A covariance of zeros with this many sensor states, at most kMaxSensorStates.
  explicit ErrorCovariance(int sensor_states = 0);

  [[nodiscard]] int sensor_states() const { return sensor_states_; }
  [[nodiscard]] int stride() const { return stride_; }
  [[nodiscard]] const Navigation& navigation() const { return nn_; }
  [[nodiscard]] Navigation& navigation() { return nn_; }
  [[nodiscard]] double sensor(int i, int j) const { return ss_[at(i, j)]; }
  /// Adds to one entry; the caller adds to its mirror image too.
  void add_sensor(int i, int j, double value) { ss_[at(i, j)] += value; }
  /// The whole matrix, for tests.
  [[nodiscard]] Eigen::MatrixXd dense() const;

  /// F, B and the diagonal of D, without noise. A step is `propagate`, then `mix` for every block of D that is not
  /// diagonal (its diagonal given as 1 to `propagate`), then `add_noise` and `add_sensor`.
  void propagate(const NavigationTransition& navigation, const SensorTransition& sensors);
  /// Applies a block of D to the sensor states from `first` on.
  void mix(int first, const Eigen::Ref<const Eigen::MatrixXd>& block);
  /// Adds the noise of the navigation states and its covariance with the sensor states.
  void add_noise(const SensorTransition& sensors);

  /// Scalar Kalman update in Joseph's form; the correction is added to `state`, which holds what earlier measurements
  /// of this moment gave.
  ScalarInnovation update(const ScalarMeasurement& measurement, State& state);
  /// The same for a measurement that depends on sensor states, and slower: it takes matrices of all states.
  ScalarInnovation update(const WideMeasurement& measurement, State& state);
  /// The innovation that `update` would find, without the update.
  [[nodiscard]] ScalarInnovation expected(const WideMeasurement& measurement, const State& state) const;

 private:
  /// P h, in navigation and sensor states.
  [[nodiscard]] State times(const WideMeasurement& measurement) const;
  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(j);
  }

  int sensor_states_ = 0;
  int stride_ = 12;
  Navigation nn_ = Navigation::Zero();
  alignas(32) std::array<double, 9 * kSensorRoom> ns_{};
  alignas(32) std::array<double, kSensorRoom * kSensorRoom> ss_{};
};

}  // namespace driftlab
