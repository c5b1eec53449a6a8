#include "core/navigate/outage_prediction.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

AxisModel gyro_axis(double white, double walk) {
  AxisModel axis;
  axis.processes =
      ModelSchedule::constant({*make_process("white_noise", {white}), *make_process("random_walk", {walk})});
  axis.bias_sd = 1e-3;
  return axis;
}

SensorErrorModel gyro_of(double white, double walk) {
  SensorErrorModel model;
  for (std::size_t c = 0; c < 3; ++c) {
    model.axes[c] = gyro_axis(white, walk);
  }
  return model;
}

TEST(OutagePrediction, OneModelPredictsOneError) {
  const SensorErrorModel model = gyro_of(5e-4, 1e-5);
  PredictionOptions options;
  options.runs = 4;
  const OutagePrediction found = *predict_outage_errors(model, model, prediction_scenario(), options);
  EXPECT_EQ(found.baseline_m.value, found.extended_m.value);
  EXPECT_EQ(found.extended_m.value, found.adopted_m.value);
  EXPECT_EQ(found.adoption_gain_m.value, 0.0);
  EXPECT_GT(found.baseline_m.value, 0.1);
  EXPECT_EQ(found.runs, 4);
  EXPECT_TRUE(found.left_out.empty());
}

TEST(OutagePrediction, AnUnmodelledWalkCostsMoreThanPromisedAndAdoptingItHelps) {
  // A random walk of 2e-4 rad/s/sqrt(s) moves the bias by 2e-3 rad/s within 100 s, where the baseline promises 1e-4.
  const SensorErrorModel baseline = gyro_of(5e-4, 1e-5);
  const SensorErrorModel extended = gyro_of(5e-4, 2e-4);
  const OutagePrediction found = *predict_outage_errors(baseline, extended);
  EXPECT_GT(found.extended_m.ci95.low, found.baseline_m.ci95.high);
  EXPECT_LT(found.adoption_gain_m.ci95.high, 0.0);
  EXPECT_NEAR(found.adopted_m.value - found.extended_m.value, found.adoption_gain_m.value, 1e-9);
}

TEST(OutagePrediction, DeterministicErrorsAreInTheDataAlone) {
  const SensorErrorModel baseline = gyro_of(5e-4, 1e-5);
  SensorErrorModel extended = baseline;
  extended.hardware.scale_factor[2] = 0.05;  // 90 deg turns come out 4.5 deg wrong: above a metre after ten seconds
  PredictionOptions options;
  options.runs = 10;
  const OutagePrediction found = *predict_outage_errors(baseline, extended, prediction_scenario(), options);
  EXPECT_GT(found.extended_m.value, found.baseline_m.value);
  EXPECT_EQ(found.adoption_gain_m.value, 0.0) << "no filter knows of a scale factor";
}

TEST(OutagePrediction, RefusesWhatNoScenarioAllows) {
  OutageScenario scenario = prediction_scenario();
  scenario.outages.clear();
  EXPECT_EQ(predict_outage_errors({}, {}, scenario).error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace driftlab
