#include "core/navigate/model_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

Model white(double n) { return {*make_process("white_noise", {n})}; }

TEST(ModelSchedule, LeavesABandOnlyBeyondTheHysteresis) {
  const ModelSchedule schedule = *ModelSchedule::by_rate({5.0, 15.0}, {white(1.0), white(2.0), white(3.0)}, 1.0);
  EXPECT_EQ(schedule.next_band(0, 5.9), 0U);
  EXPECT_EQ(schedule.next_band(0, -6.1), 1U);
  EXPECT_EQ(schedule.next_band(1, 4.1), 1U);
  EXPECT_EQ(schedule.next_band(1, 3.9), 0U);
  EXPECT_EQ(schedule.next_band(0, 40.0), 2U);
  EXPECT_EQ(schedule.next_band(2, 0.0), 0U);
  EXPECT_EQ(schedule.band(-5.1), 1U);
}

TEST(ModelSchedule, AReadingThatJittersAroundABoundDoesNotFlutter) {
  const ModelSchedule schedule = *ModelSchedule::by_rate({5.0}, {white(1.0), white(2.0)}, 0.5);
  std::size_t band = 0;
  int changes = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t next = schedule.next_band(band, 5.0 + 0.4 * std::sin(i * 1.7));
    changes += next != band ? 1 : 0;
    band = next;
  }
  EXPECT_EQ(changes, 0);
}

TEST(ModelSchedule, TrendsRunStraightInTheLogarithm) {
  const ModelSchedule schedule =
      *ModelSchedule::interpolated({0.0, 10.0, 20.0}, {white(1.0), white(4.0), white(1.0)}, 0.5);
  EXPECT_EQ(schedule.size(), 41U);
  EXPECT_NEAR(schedule.model(schedule.band(5.0))[0].parameters[0], 2.0, 1e-12);
  EXPECT_NEAR(schedule.model(schedule.band(-15.0))[0].parameters[0], 2.0, 1e-12);
  EXPECT_NEAR(schedule.model(schedule.band(100.0))[0].parameters[0], 1.0, 1e-12);
  // Neighbouring bands differ by what half a degree changes: 4^(1/20).
  for (std::size_t band = 1; band < schedule.size(); ++band) {
    const double ratio = schedule.model(band)[0].parameters[0] / schedule.model(band - 1)[0].parameters[0];
    EXPECT_LE(std::fabs(std::log(ratio)), std::log(4.0) / 20.0 + 1e-12);
  }
}

TEST(ModelSchedule, RefusesWhatAFilterCouldNotFollow) {
  const Model other{*make_process("random_walk", {1.0})};
  EXPECT_FALSE(ModelSchedule::by_rate({5.0}, {white(1.0), other}, 0.0));
  EXPECT_FALSE(ModelSchedule::by_rate({5.0}, {white(1.0)}, 0.0));
  EXPECT_FALSE(ModelSchedule::by_rate({5.0, 4.0}, {white(1.0), white(1.0), white(1.0)}, 0.0));
  EXPECT_FALSE(ModelSchedule::by_rate({5.0, 6.0}, {white(1.0), white(1.0), white(1.0)}, 0.6));
  EXPECT_FALSE(ModelSchedule::interpolated({0.0, 1e6}, {white(1.0), white(2.0)}, 1.0));
}

}  // namespace
}  // namespace driftlab
