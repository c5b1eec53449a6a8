#include "core/navigate/imu_simulator.hpp"

#include "core/navigate/gnss_simulator.hpp"
#include "core/navigate/paper_scenario.hpp"
#include "core/process/registry.hpp"
#include "core/variance/haar_variance.hpp"
#include "tests/process_examples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDt = 0.01;

/// Haar variances of simulated noise against the law; edf of a Haar estimate over M samples at half length m is at
/// least M/(4 m), so five standard deviations of the mean over all paths are 5 sqrt(2 x 4 m/(M paths)).
void expect_law(const ModelSchedule& schedule, std::span<const double> rates, const Model& law, std::uint64_t stream) {
  constexpr std::size_t kSamples = 8192;
  constexpr int kPaths = 20;
  std::vector<double> mean;
  std::vector<double> half;
  for (int path = 0; path < kPaths; ++path) {
    Random random(77, 100 * stream + static_cast<std::uint64_t>(path));
    const auto y = simulate_axis(schedule, rates, kDt, kSamples, random);
    const HaarVariance curve = haar_variance(y, 0.0);
    mean.resize(curve.variance.size(), 0.0);
    half.assign(curve.half.begin(), curve.half.end());
    for (std::size_t j = 0; j < mean.size(); ++j) {
      mean[j] += curve.variance[j] / kPaths;
    }
  }
  for (std::size_t j = 0; j < mean.size() && half[j] <= 256.0; ++j) {
    const double expected = haar_variance(law, half[j], kDt);
    const double tolerance = 5.0 * std::sqrt(8.0 * half[j] / (8192.0 * kPaths));
    EXPECT_NEAR(mean[j], expected, tolerance * expected + 1e-30) << law.front().kind->name << " m=" << half[j];
  }
}

TEST(ImuSimulator, NoiseObeysTheLawOfEveryRegisteredProcess) {
  for (const ProcessKind& kind : process_registry()) {
    const Process process = example_of(kind, 2.0, kDt);
    expect_law(ModelSchedule::constant({process}), {}, {process}, registry_index(&kind));
  }
}

TEST(ImuSimulator, SwitchedNoiseObeysTheLawOfItsBand) {
  const auto gyroscope = paper_true_gyroscope(0.0, true);
  const std::vector<double> rates(8192, 9.0 * kDegree);
  expect_law(gyroscope[2].processes, rates, gyroscope[2].processes.model(1), 50);
  // A process of more than one state switches too.
  const Model weak{*make_process("quantization_noise", {0.01})};
  const Model strong{*make_process("quantization_noise", {0.05})};
  const ModelSchedule schedule = *ModelSchedule::by_rate({0.1}, {weak, strong}, 0.0);
  expect_law(schedule, std::vector<double>(8192, 0.2), strong, 51);
  expect_law(schedule, std::vector<double>(8192, 0.0), weak, 52);
}

std::vector<ImuSample> constant_samples(std::size_t count, const ImuSample& value) {
  return std::vector<ImuSample>(count, value);
}

TEST(ImuSimulator, AppliesDeterministicErrorsOfThePapersEquations) {
  ImuHardware hardware;
  hardware.bias = {0.01, 0.0, -0.02, 0.1, 0.0, 0.0};
  hardware.scale_factor = {0.001, 0.0, 0.0, 0.0, 0.0, -0.002};
  hardware.gyroscope_misalignment(0, 2) = 0.005;
  hardware.accelerometer_misalignment(1, 2) = -0.003;
  ASSERT_TRUE(check(hardware));
  const ImuSample ideal{0.5, -0.2, 0.3, 1.0, 2.0, -9.8};
  const ImuRun run = simulate_imu(constant_samples(3, ideal), kDt, ImuModel{}, hardware, 1, 0);
  EXPECT_DOUBLE_EQ(run.readings[1][0], 0.5 * 1.001 + 0.005 * 0.3 + 0.01);
  EXPECT_DOUBLE_EQ(run.readings[1][1], -0.2);
  EXPECT_DOUBLE_EQ(run.readings[1][4], 2.0 + 0.003 * 9.8);
  EXPECT_DOUBLE_EQ(run.readings[1][5], -9.8 * (1.0 - 0.002));
}

TEST(ImuSimulator, QuantizesAndClips) {
  ImuHardware hardware;
  hardware.quantization_step[0] = 0.01;
  hardware.range[0] = 0.5;
  std::vector<ImuSample> ideal;
  for (int i = 0; i < 1000; ++i) {
    ideal.push_back({std::sin(0.1 * i), 0.0, 0.0, 0.0, 0.0, 0.0});
  }
  const ImuRun run = simulate_imu(ideal, kDt, ImuModel{}, hardware, 1, 0);
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const double steps = run.readings[i][0] / 0.01;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::fabs(run.readings[i][0]), 0.5 + 1e-12);
    EXPECT_NEAR(run.readings[i][0], std::clamp(ideal[i][0], -0.5, 0.5), 0.005 + 1e-12);
  }
}

TEST(ImuSimulator, BandwidthHalvesThePowerAtItsCorner) {
  ImuHardware hardware;
  hardware.bandwidth_hz[2] = 10.0;
  std::vector<ImuSample> ideal;
  for (int i = 0; i < 20000; ++i) {
    ideal.push_back({0.0, 0.0, std::sin(2.0 * std::numbers::pi * 10.0 * i * kDt), 0.0, 0.0, 0.0});
  }
  const ImuRun run = simulate_imu(ideal, kDt, ImuModel{}, hardware, 1, 0);
  double power = 0.0;
  for (std::size_t i = 10000; i < 20000; ++i) {
    power += run.readings[i][2] * run.readings[i][2] / 10000.0;
  }
  EXPECT_NEAR(power, 0.25, 1e-3);
}

TEST(ImuSimulator, RunsAndChannelsAreIndependentAndRepeatable) {
  ImuModel model;
  for (AxisModel& axis : model.axes) {
    axis.bias_sd = 0.1;
    axis.processes = ModelSchedule::constant({*make_process("white_noise", {0.01})});
  }
  const auto ideal = constant_samples(500, {});
  const ImuRun first = simulate_imu(ideal, kDt, model, {}, 5, 3);
  EXPECT_EQ(simulate_imu(ideal, kDt, model, {}, 5, 3).readings, first.readings);
  EXPECT_NE(simulate_imu(ideal, kDt, model, {}, 5, 4).bias, first.bias);
  ImuModel more = model;
  more.axes[0].processes =
      ModelSchedule::constant({*make_process("white_noise", {0.01}), *make_process("random_walk", {1.0})});
  const ImuRun changed = simulate_imu(ideal, kDt, more, {}, 5, 3);
  EXPECT_NE(changed.readings[400][0], first.readings[400][0]);
  EXPECT_EQ(changed.readings[400][1], first.readings[400][1]);
}

Trajectory still(double duration_s) {
  SegmentPlan plan;
  plan.duration_s = duration_s;
  plan.start = {0.7, 0.1, 50.0};
  plan.speed_m_s = 10.0;
  plan.heading_rad = 0.5;
  return *make_trajectory(**make_segment_motion(plan), 100.0);
}

TEST(GnssSimulator, ErrorsHaveTheStatedSizeInNorthEastDown) {
  const Trajectory truth = still(2000.0);
  GnssModel model;
  model.rate_hz = 5.0;
  Random random(3);
  const auto fixes = simulate_gnss(truth, model, {}, random);
  ASSERT_EQ(fixes.size(), 10000U);
  Vector3 position = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    const NavigationState& state = truth.states[20 * (k + 1)];
    const Matrix3 axes = ned_axes(state.position_ecef_m);
    position += (axes.transpose() * (fixes[k].position_ecef_m - state.position_ecef_m)).cwiseAbs2() / 1e4;
    velocity += (axes.transpose() * (*fixes[k].velocity_ecef_m_s - state.velocity_ecef_m_s)).cwiseAbs2() / 1e4;
  }
  for (Eigen::Index k = 0; k < 3; ++k) {  // five standard deviations of a variance of 10^4 draws: 7 %
    EXPECT_NEAR(position(k), std::pow(model.position_sd_m(k), 2), 0.07 * std::pow(model.position_sd_m(k), 2));
    EXPECT_NEAR(velocity(k), std::pow(model.velocity_sd_m_s(k), 2), 0.07 * std::pow(model.velocity_sd_m_s(k), 2));
  }
}

TEST(GnssSimulator, OutagesRemoveFixesAndNothingElse) {
  const Trajectory truth = still(60.0);
  Random a(9);
  Random b(9);
  const auto all = simulate_gnss(truth, {}, {}, a);
  const auto some = simulate_gnss(truth, {}, {{20.0, 10.0}}, b);
  ASSERT_EQ(all.size(), 60U);
  ASSERT_EQ(some.size(), 50U);
  for (const GnssFix& fix : some) {
    EXPECT_TRUE(fix.arrival_s < 20.0 || fix.arrival_s >= 30.0);
    const auto same = static_cast<std::size_t>(std::llround(fix.validity_s)) - 1;
    EXPECT_EQ(fix.position_ecef_m, all[same].position_ecef_m);
  }
}

TEST(GnssSimulator, CorrelatedErrorKeepsItsTimeAndLateFixesTheirMoment) {
  const Trajectory truth = still(3000.0);
  GnssModel model;
  model.position_sd_m.setConstant(1e-3);
  model.correlated_sd_m.setConstant(2.0);
  model.correlation_time_s = 10.0;
  model.latency_s = 0.3;
  Random random(4);
  const auto fixes = simulate_gnss(truth, model, {}, random);
  double zero = 0.0;
  double ten = 0.0;
  std::vector<double> north;
  for (const GnssFix& fix : fixes) {
    EXPECT_NEAR(fix.arrival_s - fix.validity_s, 0.3, 1e-12);
    const auto sample = static_cast<std::size_t>(std::llround(fix.validity_s * 100.0));
    const Vector3 gap = fix.position_ecef_m - truth.states[sample].position_ecef_m;
    north.push_back(ned_axes(truth.states[sample].position_ecef_m).col(0).dot(gap));
  }
  for (std::size_t k = 0; k + 10 < north.size(); ++k) {
    zero += north[k] * north[k];
    ten += north[k] * north[k + 10];
  }
  // 3000 s hold 150 independent stretches of 20 s: the correlation e^-1 is known to 0.1.
  EXPECT_NEAR(ten / zero, std::exp(-1.0), 0.2);
  EXPECT_NEAR(std::sqrt(zero / static_cast<double>(north.size())), 2.0, 0.5);
}

}  // namespace
}  // namespace driftlab
