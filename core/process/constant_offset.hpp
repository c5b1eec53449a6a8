#pragma once
/// A constant drawn once per recording: turn-on to turn-on bias.
///
/// It has no wavelet variance at any scale, so that one recording alone says nothing of it, and it stands in no model
/// of a single recording: the registry does not hold it. Over several recordings its states show (slow_law.hpp).
#include "core/process/parameter.hpp"
#include "core/process/process_kind.hpp"
#include "core/process/random.hpp"
#include "core/process/slow_law.hpp"
#include "core/process/state_space.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace driftlab {

struct ConstantOffset {
  static constexpr std::string_view kName = "constant_offset";
  static constexpr std::string_view kSymbol = "OFF";
  static constexpr std::string_view kTitle = "constant that differs from recording to recording";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "sigma"}};

  double sigma = 1.0;  ///< standard deviation over recordings [unit]

  [[nodiscard]] double haar_variance(double /*m*/, double /*dt_s*/) const { return 0.0; }
  void haar_gradient(double /*m*/, double /*dt_s*/, std::span<double> out) const { out[0] = 0.0; }
  [[nodiscard]] std::optional<double> spectral_density(double /*f_hz*/, double /*dt_s*/) const { return std::nullopt; }
  [[nodiscard]] std::optional<double> autocovariance(double /*lag*/, double /*dt_s*/) const { return sigma * sigma; }
  [[nodiscard]] double variogram(double /*lag*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] double haar_cross(double /*mi*/, double /*mj*/, double /*h*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] std::optional<StateSpace> state_space(double /*dt_s*/) const {
    StateSpace model;
    model.phi = Eigen::MatrixXd::Identity(1, 1);
    model.q = Eigen::MatrixXd::Zero(1, 1);
    model.h = Eigen::RowVectorXd::Ones(1);
    model.mean0 = Eigen::VectorXd::Zero(1);
    model.cov0 = Eigen::MatrixXd::Constant(1, 1, sigma * sigma);
    return model;
  }
  void add_path(Random& random, double /*dt_s*/, std::span<double> out) const {
    const double offset = sigma * random.normal();
    std::for_each(out.begin(), out.end(), [offset](double& value) { value += offset; });
  }
  static void add_block_states(double square, double /*shape*/, const Blocks& /*blocks*/, BlockStates& states) {
    states.phi.push_back(1.0);
    states.q.push_back(0.0);
    states.p0.push_back(square);
  }
};

[[nodiscard]] inline const ProcessKind& constant_offset() {
  static const ProcessKind kind = kind_of<ConstantOffset>();
  return kind;
}

}  // namespace driftlab
