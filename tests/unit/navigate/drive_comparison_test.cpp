// Several models as filters on one drive: paired differences, what is said of them, and levels that follow the rate.
#include "core/navigate/drive/comparison.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::drive {
namespace {

/// A gyroscope that is believed to have no bias: the truth has one of 0.1 deg/s.
ImuModel blind_model() {
  ImuModel model = unit_model();
  for (std::size_t c = 0; c < 3; ++c) {
    model.axes[c].bias_sd = 0.0;
    model.axes[c].processes = ModelSchedule::constant({*make_process("white_noise", {0.02 * kDegree})});
  }
  return model;
}

/// Two bands of the turning rate, both of `factor` times the true white noise.
AxisModel banded_axis(double factor) {
  AxisModel axis = unit_model().axes[2];
  const Model loud{*make_process("white_noise", {0.02 * kDegree * factor}), *make_process("random_walk", {2e-5})};
  axis.processes = *ModelSchedule::by_rate({5.0 * kDegree}, {loud, loud}, 0.5 * kDegree);
  return axis;
}

TEST(DriveComparison, OfOneModelWithItselfShowsNothing) {
  const auto compared = compare_filters(simulated_drive(51), {{"one", "", unit_model()}, {"other", "", unit_model()}},
                                        options_of(Document{}));
  ASSERT_TRUE(compared) << compared.error().message;
  const FilterDifference* const ten = compared->difference("other", "one", 10.0);
  ASSERT_NE(ten, nullptr);
  EXPECT_EQ(ten->difference_m.value, 0.0);
  EXPECT_EQ(ten->relative.ci95.high, 0.0);
  EXPECT_FALSE(ten->shown());
  const auto verdicts = verdicts_of(*compared);
  ASSERT_EQ(verdicts.size(), 3U);
  EXPECT_NE(verdicts.front().find("no difference from one larger than 0 % is shown"), std::string::npos)
      << verdicts.front();
}

TEST(DriveComparison, ShowsAModelThatIsWrongAndByHowMuch) {
  const auto compared = compare_filters(
      simulated_drive(52),
      {{"right", "", unit_model()}, {"blind", "", blind_model()}, {"also right", "", unit_model()}}, {});
  ASSERT_TRUE(compared) << compared.error().message;
  const FilterDifference* const ten = compared->difference("blind", "right", 10.0);
  ASSERT_NE(ten, nullptr);
  EXPECT_TRUE(ten->shown());
  EXPECT_GT(ten->difference_m.ci95.low, 0.0);
  const double mean_of_blind = compared->filters[1].durations.front().mean_m;
  const double mean_of_right = compared->filters[0].durations.front().mean_m;
  EXPECT_DOUBLE_EQ(ten->relative.value, mean_of_blind / mean_of_right - 1.0);
  const std::string verdict = verdicts_of(*compared).front();
  EXPECT_NE(verdict.find("blind errs"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("more than right"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("no other difference from right larger than 0 % is shown"), std::string::npos) << verdict;
}

TEST(DriveComparison, FitsTheLevelOfAModelThatFollowsTheRate) {
  // Levels of models by rate were left as they are: a comparison on the road then judged their wrong level.
  ImuModel loud = unit_model();
  for (std::size_t c = 0; c < 3; ++c) {
    loud.axes[c] = banded_axis(8.0);
  }
  ComparisonOptions settings;
  settings.fit_noise = true;
  settings.resamples = 50;
  const auto compared =
      compare_filters(simulated_drive(53), {{"right", "", unit_model()}, {"loud", "", loud}}, {}, settings);
  ASSERT_TRUE(compared) << compared.error().message;
  // The likelihood's level scatters by 10 % on a drive of this length; 0.3 is three times that.
  EXPECT_NEAR(std::log(compared->filters[0].gyro_noise), 0.0, 0.3);
  EXPECT_NEAR(std::log(8.0 * compared->filters[1].gyro_noise), std::log(compared->filters[0].gyro_noise), 0.1);
}

TEST(DriveComparison, RefusesOneModelAndTwoOfOneName) {
  const Drive drive = simulated_drive(54);
  EXPECT_FALSE(compare_filters(drive, {{"one", "", unit_model()}}, {}));
  const auto twice = compare_filters(drive, {{"one", "", unit_model()}, {"one", "", unit_model()}}, {});
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("'one'"), std::string::npos);
}

TEST(DriveNoise, IsScaledInEveryBandOfARate) {
  AxisModel axis = banded_axis(1.0);
  scale_white_noise(axis, 3.0);
  ASSERT_EQ(axis.processes.size(), 2U);
  for (std::size_t band = 0; band < 2; ++band) {
    EXPECT_DOUBLE_EQ(axis.processes.model(band)[0].parameters[0], 0.06 * kDegree);
    EXPECT_DOUBLE_EQ(axis.processes.model(band)[1].parameters[0], 2e-5) << "a slow process is no white noise";
  }
  EXPECT_EQ(axis.processes.bounds_rad_s(), banded_axis(1.0).processes.bounds_rad_s());
  EXPECT_EQ(axis.processes.hysteresis_rad_s(), 0.5 * kDegree);
}

}  // namespace
}  // namespace driftlab::drive
