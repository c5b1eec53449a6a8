#pragma once
/// Random walk: integrated white noise (rate random walk of a gyro).
///
/// Steps of variance q = K^2 dt; Allan variance K^2 tau/3 for tau >> dt. Not stationary: only its increments are.
#include "core/process/haar_differences.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/slow_law.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace driftlab {

struct RandomWalk {
  static constexpr std::string_view kName = "random_walk";
  static constexpr std::string_view kSymbol = "RW";
  static constexpr std::string_view kTitle = "random walk (rate random walk)";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "K", .second_power_halves = -1}};

  double k = 1.0;  ///< [unit / sqrt(s)]

  /// q (n^2 + 2)/(12 n), n = 2m.
  [[nodiscard]] double haar_variance(double m, double dt_s) const {
    return k * k * dt_s * (2.0 * m * m + 1.0) / (12.0 * m);
  }
  void haar_gradient(double m, double dt_s, std::span<double> out) const {
    out[0] = 2.0 * k * dt_s * (2.0 * m * m + 1.0) / (12.0 * m);
  }
  /// Pseudo-density of the sampled walk; infinite at f = 0.
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const {
    const double s = 2.0 * scaled_phase(f_hz * dt_s, 1.0).sine;
    return dt_s * k * k * dt_s / (s * s);
  }
  [[nodiscard]] std::optional<double> autocovariance(double /*lag*/, double /*dt_s*/) const { return std::nullopt; }
  [[nodiscard]] double variogram(double lag, double dt_s) const { return k * k * dt_s * std::fabs(lag); }
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const {
    if (h >= mi + mj) {
      return 0.0;
    }
    return k * k * dt_s * haar_cross_of(mi, mj, h, [](double lag) {
             const double distance = std::fabs(lag);
             return -distance * (distance * distance - 1.0) / 12.0;
           });
  }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// One state that starts at 0; an unknown start belongs to the constant bias.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const {
    StateSpace model;
    model.phi = Eigen::MatrixXd::Identity(1, 1);
    model.q = Eigen::MatrixXd::Constant(1, 1, k * k * dt_s);
    model.h = Eigen::RowVectorXd::Ones(1);
    model.mean0 = Eigen::VectorXd::Zero(1);
    model.cov0 = Eigen::MatrixXd::Zero(1, 1);
    return model;
  }
  void add_path(Random& random, double dt_s, std::span<double> out) const {
    const double sd = k * std::sqrt(dt_s);
    double level = 0.0;
    for (double& value : out) {
      value += level;
      level += sd * random.normal();
    }
  }
  /// Means over L samples have increments of variance q (2/3 + 1/(3 L^2)) and lag-one covariance q (1/6 - 1/(6 L^2)),
  /// q = K^2 L dt: a walk of step variance q and a white remainder -q (1 - 1/L^2)/6. Zero at the first sample of the
  /// file.
  static void add_block_states(double square, double /*shape*/, const Blocks& blocks, BlockStates& states) {
    const auto block = static_cast<double>(blocks.block);
    const double q = square * blocks.block_s();
    states.phi.push_back(1.0);
    states.q.push_back(q);
    states.p0.push_back(square * (blocks.start_s + 0.5 * blocks.block_s()));
    states.remainder -= q * (1.0 - 1.0 / (block * block)) / 6.0;
  }
  /// 2 K^2 dt^2 / |1 - exp(-i w)|^2, twice the density, for the ends of the record do not meet.
  [[nodiscard]] static double expected_periodogram(double square, double /*shape*/, double f_hz, double dt_s,
                                                   double /*samples*/) {
    const double s = 2.0 * std::sin(std::numbers::pi * f_hz * dt_s);
    return 2.0 * square * dt_s * dt_s / (s * s);
  }
};

}  // namespace driftlab
