/// What findings become in a navigation simulation, and what they cost there.
#include "core/investigate/report/outage_gain.hpp"

#include "core/investigate/causes/cause.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

using testing::ElementsAre;

constexpr double kNoise = 1e-4;  // [rad/sqrt(s)]

ChannelGroup gyro_group(const char* column, const char* axis) {
  ChannelGroup group;
  group.column = column;
  group.role = {Quantity::AngularRate, axis, std::nullopt};
  return group;
}

Report with_noise_alone(const char* column) {
  Report report;
  ChannelModel model;
  model.channel = column;
  model.alone.noise.white = kNoise * kNoise;
  model.beside = model.alone;
  report.models.push_back(model);
  return report;
}

Finding found(const char* cause, std::vector<double> values, double shape = 0.0) {
  Finding finding;
  finding.evidence.cause = find_cause(cause);
  finding.evidence.shape = shape;
  for (const double value : values) {
    finding.evidence.parameters.push_back({"", {value, {value, value}}, {}});
  }
  return finding;
}

std::vector<std::string> names_of(const std::optional<AxisModel>& axis) {
  std::vector<std::string> names;
  for (const Process& process : axis->processes.model(0)) {
    names.emplace_back(process.kind->name);
  }
  return names;
}

TEST(OutageGain, AFindingBecomesWhatANavigationSimulationHoldsOrIsNamed) {
  Report report = with_noise_alone("gy");
  for (const Finding& finding :
       {found("gauss_markov", {1e-3, 0.01}), found("white_noise_level", {3.0 * kNoise}), found("linear_drift", {1e-7}),
        found("periodic_disturbance", {1e-3, 2.0}), found("turn_on_bias", {0.3}), found("scale_factor_error", {400e-6}),
        found("axis_misalignment", {0.01}, 2.0), found("saturation", {0.7}), found("output_resolution", {1e-3}),
        found("band_limited_noise", {5.0}), found("stuck_samples", {0.1, 3.0})}) {
    report.findings.push_back(finding);
  }
  const OutageScenario scenario = prediction_scenario();
  const SensorModels models = sensor_models(report, {gyro_group("gy", "y")}, scenario);
  EXPECT_THAT(names_of(models.baseline.axes[1]), ElementsAre("white_noise"));
  EXPECT_THAT(names_of(models.extended.axes[1]),
              testing::UnorderedElementsAre("white_noise", "gauss_markov", "linear_drift", "sinusoid"));
  EXPECT_FALSE(models.extended.axes[0] || models.extended.axes[2]);
  EXPECT_EQ(models.baseline.axes[1]->bias_sd, scenario.truth.axes[1].bias_sd);
  EXPECT_DOUBLE_EQ(models.extended.axes[1]->bias_sd, std::hypot(scenario.truth.axes[1].bias_sd, 0.3));
  const ImuHardware& unit = models.extended.hardware;
  EXPECT_EQ(unit.scale_factor[1], 400e-6);
  EXPECT_EQ(unit.gyroscope_misalignment(1, 2), 0.01);
  EXPECT_EQ(unit.range[1], 0.7);
  EXPECT_EQ(unit.quantization_step[1], 1e-3);
  EXPECT_EQ(unit.bandwidth_hz[1], 5.0);
  EXPECT_EQ(models.baseline.hardware.scale_factor[1], 0.0);
  EXPECT_THAT(models.left_out, ElementsAre("stuck_samples of gy"));
}

TEST(OutageGain, SlowNoiseThatTheBaselineLacksCostsMetresAndAFilterThatKnowsItLosesFewer) {
  Report report = with_noise_alone("gz");
  report.findings.push_back(found("random_walk", {1e-4}));  // [rad/s/sqrt(s)]
  const std::vector<ChannelGroup> groups{gyro_group("gz", "z")};
  const auto one = outage_gain(report, groups);
  ASSERT_TRUE(one && *one);
  EXPECT_GT((*one)->extended_m.value, 1.3 * (*one)->baseline_m.value);
  EXPECT_LT((*one)->adopted_m.value, (*one)->extended_m.value);
  Executor executor(2);
  RunControl control;
  control.threads.executor = &executor;
  const auto two = outage_gain(report, groups, control);
  ASSERT_TRUE(two && *two);
  EXPECT_EQ((*two)->extended_m.value, (*one)->extended_m.value) << "depends on the number of threads";
}

TEST(OutageGain, WithoutAFindingBothModelsPredictTheSame) {
  const auto gain = outage_gain(with_noise_alone("gz"), {gyro_group("gz", "z")});
  ASSERT_TRUE(gain && *gain);
  EXPECT_EQ((*gain)->baseline_m.value, (*gain)->extended_m.value);
}

TEST(OutageGain, AColumnThatIsNoAxisOfAnInertialUnitHasNone) {
  ChannelGroup group = gyro_group("m", "z");
  group.role.quantity = Quantity::MagneticField;
  const auto gain = outage_gain(with_noise_alone("m"), {group});
  ASSERT_TRUE(gain);
  EXPECT_FALSE(*gain);
}

}  // namespace
}  // namespace driftlab::investigate
