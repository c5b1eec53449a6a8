#include "core/navigate/channel_dynamics.hpp"

#include "core/process/registry.hpp"
#include "tests/process_examples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

Model model_of(std::string_view name, std::vector<double> values) { return {*make_process(name, std::move(values))}; }

TEST(ChannelDynamics, ConstantBiasGivesPowersOfTime) {
  const ChannelDynamics axis = *make_channel_dynamics({}, 0.1, kDt, 20);
  const double t = 20 * kDt;
  ASSERT_EQ(axis.states, 1);
  EXPECT_NEAR(axis.steps[19].gain(0, 0), t, 1e-14);
  EXPECT_NEAR(axis.steps[19].gain(1, 0), t * t / 2.0, 1e-14);
  EXPECT_NEAR(axis.steps[19].gain(2, 0), t * t * t / 6.0, 1e-14);
  EXPECT_EQ(axis.start_covariance(0, 0), 0.1 * 0.1);
}

TEST(ChannelDynamics, WhiteNoiseIntegratesLikeARandomWalk) {
  // Continuous limit N^2 (T, T^2/2, T^3/6; T^3/3, ...): the sampled noise differs by (dt/T)^2 at most.
  const double n = 0.3;
  const ChannelDynamics axis = *make_channel_dynamics(model_of("white_noise", {n}), 0.0, kDt, 100);
  const Matrix3& q = axis.steps[99].integral_noise;
  EXPECT_EQ(axis.states, 0);
  EXPECT_NEAR(q(0, 0), n * n, 1e-12);
  EXPECT_NEAR(q(0, 1), n * n / 2.0, 1e-12);
  EXPECT_NEAR(q(1, 1), n * n / 3.0, n * n * 1e-4);
  EXPECT_NEAR(q(2, 2), n * n / 20.0, n * n * 1e-4);
}

TEST(ChannelDynamics, GaussMarkovMatchesItsContinuousIntegrals) {
  // Gains (1 - e^-bT)/b and so on; process noise of I1 is the variance of the integral started at 0:
  // (2 s^2/b) (T - 2 (1 - e)/b + (1 - e^2)/(2 b)). A sample held over dt differs by b dt/2 relative.
  const double sigma = 2.0;
  const double beta = 0.5;
  const ChannelDynamics axis = *make_channel_dynamics(model_of("gauss_markov", {sigma, beta}), 0.0, 1e-3, 1000);
  const double e = std::exp(-beta);
  const double i1 = (1.0 - e) / beta;
  EXPECT_NEAR(axis.steps[999].gain(0, 0), i1, 3e-4 * i1);
  EXPECT_NEAR(axis.steps[999].gain(1, 0), (1.0 - i1) / beta, 3e-4);
  const double variance = 2.0 * sigma * sigma / beta * (1.0 - 2.0 * i1 + (1.0 - e * e) / (2.0 * beta));
  EXPECT_NEAR(axis.steps[999].integral_noise(0, 0), variance, 2e-3 * variance);
}

/// Every registered process with a state space: integrals of simulated paths have the variance that the steps predict.
TEST(ChannelDynamics, PredictsTheIntegralsOfEverySimulatedProcess) {
  constexpr int kSamples = 50;
  constexpr int kPaths = 4000;
  for (const ProcessKind& kind : process_registry()) {
    const Process process = example_of(kind, 3.0, kDt);
    if (!process.state_space(kDt) || process.state_space(kDt)->relative_error > 0.0) {
      continue;  // an approximation starts as it likes; its error is told by the process's own tests
    }
    const ChannelDynamics axis = *make_channel_dynamics({process}, 0.0, kDt, kSamples);
    const ChannelStep& step = axis.steps.back();
    // Second moment of I1 and I2 with the start's mean and covariance.
    const Eigen::MatrixXd start = Eigen::MatrixXd(axis.start_covariance) + axis.start * axis.start.transpose();
    const Eigen::Matrix3d expected = step.gain * start * step.gain.transpose() + step.integral_noise;
    Random random(20, registry_index(&kind));
    double first = 0.0;
    double second = 0.0;
    for (int path = 0; path < kPaths; ++path) {
      const std::vector<double> y = simulate({process}, random, kDt, kSamples);
      double i1 = 0.0;
      double i2 = 0.0;
      for (const double value : y) {
        i2 += i1 * kDt + value * kDt * kDt / 2.0;
        i1 += value * kDt;
      }
      first += i1 * i1 / kPaths;
      second += i2 * i2 / kPaths;
    }
    // A variance from 4000 draws has a relative standard deviation of at most sqrt(2/4000) = 2.2 %; four of them.
    EXPECT_NEAR(first, expected(0, 0), 0.09 * expected(0, 0) + 1e-15) << kind.name;
    EXPECT_NEAR(second, expected(1, 1), 0.09 * expected(1, 1) + 1e-15) << kind.name;
  }
}

TEST(ChannelDynamics, HoldsFlickerNoiseAndRefusesMoreStatesThanItHas) {
  EXPECT_EQ(make_channel_dynamics(model_of("flicker_noise", {1e-4}), 1e-3, kDt, 10)->states, 17);
  Model model;
  for (int i = 0; i < 20; ++i) {
    model.push_back(*make_process("gauss_markov", {1.0, 1.0 + i}));
  }
  EXPECT_EQ(make_channel_dynamics(model, 1.0, kDt, 1).error().code, ErrorCode::LimitExceeded);
  EXPECT_TRUE(make_channel_dynamics(model, 0.0, kDt, 1));
}

}  // namespace
}  // namespace driftlab
