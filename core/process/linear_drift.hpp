#pragma once
/// Linear drift: the deterministic ramp R t (rate ramp of IEEE Std 952).
///
/// Every Haar coefficient has the mean w m/2 (w = R dt) and no scatter: WV = w^2 m^2/4, Allan variance R^2 tau^2/2.
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace driftlab {

struct LinearDrift {
  static constexpr std::string_view kName = "linear_drift";
  static constexpr std::string_view kSymbol = "DR";
  static constexpr std::string_view kTitle = "linear drift (rate ramp)";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "R", .second_power_halves = -2, .lower = -1e300}};

  double r = 1.0;  ///< [unit / s]; only |R| can be seen in a variance

  [[nodiscard]] double haar_variance(double m, double dt_s) const { return 0.25 * (r * dt_s * m) * (r * dt_s * m); }
  void haar_gradient(double m, double dt_s, std::span<double> out) const { out[0] = 0.5 * r * (dt_s * m) * (dt_s * m); }
  /// Deterministic: no density.
  [[nodiscard]] std::optional<double> spectral_density(double /*f_hz*/, double /*dt_s*/) const { return std::nullopt; }
  [[nodiscard]] std::optional<double> autocovariance(double /*lag*/, double /*dt_s*/) const { return std::nullopt; }
  /// Mean squared increment.
  [[nodiscard]] double variogram(double lag, double dt_s) const { return (r * lag * dt_s) * (r * lag * dt_s); }
  [[nodiscard]] double haar_cross(double /*mi*/, double /*mj*/, double /*h*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] double haar_mean(double m, double dt_s) const { return 0.5 * r * dt_s * m; }
  /// Value and slope, both known at the start: (0, R).
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const {
    StateSpace model;
    model.phi = Eigen::MatrixXd::Identity(2, 2);
    model.phi(0, 1) = dt_s;
    model.q = Eigen::MatrixXd::Zero(2, 2);
    model.h = Eigen::RowVectorXd::Unit(2, 0);
    model.mean0 = r * Eigen::VectorXd::Unit(2, 1);
    model.cov0 = Eigen::MatrixXd::Zero(2, 2);
    return model;
  }
  void add_path(Random& /*random*/, double dt_s, std::span<double> out) const {
    for (std::size_t t = 0; t < out.size(); ++t) {
      out[t] += r * dt_s * static_cast<double>(t);
    }
  }
  [[nodiscard]] double slope() const { return r; }
};

}  // namespace driftlab
