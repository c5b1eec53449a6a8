#include "core/investigate/fullrate/modulation.hpp"

#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::investigate {
namespace {

/// Variance 1 + x at level 1, 1 at level 0.
double raised(double u, double x) { return 1.0 + x * u; }

TEST(Modulation, AScopeHasTwoLevelsOfTheSamplesInUse) {
  NoiseAtFullRate noise({{1.0, 2.0}, {3.0, 9.0, 1.0}});
  noise.data.used[1][2] = 0;
  const Modulation levels = modulation_of_scope(noise.data, {1});
  EXPECT_EQ(levels.u, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(levels.count, (std::vector<double>{2.0, 2.0}));
  EXPECT_EQ(levels.square, (std::vector<double>{5.0, 9.0 + 25.0})) << "squares are cut at 25";
}

TEST(Modulation, ADriverIsSortedIntoLevelsByItsModulus) {
  NoiseAtFullRate noise({std::vector<double>(500, 2.0), std::vector<double>(100, 1.0)});
  noise.recordings[0].begin = 100;  // the driver spans the file, the innovations its analysed part
  noise.recordings[0].end = 600;
  std::vector<double> rate;
  for (int i = 0; i < 600; ++i) {
    rate.push_back((i % 2 == 0 ? 1.0 : -1.0) * i / 599.0);
  }
  noise.recordings[0].rate[2] = rate;
  const Modulation levels = modulation_of(
      noise.data, [](const StudyRecording& recording, std::size_t axis) { return &recording.rate.at(axis); });
  EXPECT_EQ(levels.largest, 1.0);
  EXPECT_EQ(std::accumulate(levels.count.begin(), levels.count.end(), 0.0), 600.0);
  EXPECT_EQ(std::accumulate(levels.square.begin(), levels.square.end(), 0.0), 500.0 * 4.0 + 100.0);
  EXPECT_EQ(levels.square[0], 100.0) << "a recording without the driver counts as 0";
  double sum = 0.0;
  for (std::size_t j = 0; j < levels.u.size(); ++j) {
    sum += levels.u[j] * levels.count[j];
    EXPECT_TRUE(levels.count[j] == 0.0 || std::fabs(levels.u[j] - static_cast<double>(j) / 60.0) < 0.5 / 60.0 + 1e-12);
  }
  EXPECT_NEAR(sum, 500.0 * (100.0 + 599.0) / 2.0 / 599.0, 1e-9) << "a level stands at the mean of its samples";
  EXPECT_EQ(levels.distinct, 1U + 61U - 10U);  // zero, and 100/599 to 1 of sixty levels: those from 10 to 60
}

TEST(Modulation, TwoLevelsOfKnownScaleHaveAClosedForm) {
  // Variance v at level 1: v = S1/n1, and twice the log likelihood gained is n1 (v - 1 - ln v); the profile falls by
  // 3.84 where n1 (ln(w/v) + v/w - 1) does.
  Modulation levels;
  levels.u = {0.0, 1.0};
  levels.count = {3000.0, 2000.0};
  levels.square = {2900.0, 2500.0};
  const ModulationFit fit = fit_modulation(levels, true, 1.0, raised);
  const double v = 1.25;
  EXPECT_NEAR(fit.value, v - 1.0, 1e-5);
  EXPECT_EQ(fit.scale, 1.0);
  EXPECT_NEAR(fit.gain, 2000.0 * (v - 1.0 - std::log(v)), 1e-5);
  for (const double end : {fit.interval.low, fit.interval.high}) {
    const double w = 1.0 + end;
    EXPECT_NEAR(2000.0 * (std::log(w / v) + v / w - 1.0), 3.8415, 0.02) << end;
  }
  EXPECT_LT(fit.interval.low, fit.value);
  EXPECT_GT(fit.interval.high, fit.value);
}

TEST(Modulation, TwoLevelsOfFreeScaleAreTheRatioOfTheirVariances) {
  Modulation levels;
  levels.u = {0.0, 1.0};
  levels.count = {3000.0, 2000.0};
  levels.square = {6000.0, 3600.0};
  const ModulationFit fit = fit_modulation(levels, false, 1.0, raised);
  EXPECT_NEAR(fit.value, 1.8 / 2.0 - 1.0, 1e-5);
  EXPECT_NEAR(fit.scale, 2.0, 1e-4);
  EXPECT_NEAR(fit.gain, 5000.0 * std::log(9600.0 / 5000.0) - 3000.0 * std::log(2.0) - 2000.0 * std::log(1.8), 1e-5);
}

TEST(Modulation, IntervalsHoldTheTruthAndGainsOfNothingAreChiSquare) {
  // Noise of variance 0.81 (1 + x u) with u rising from 0 to 1: 200 intervals of 95 % hold x 190 times, +- 3.2 standard
  // deviations of 3.1; a modulation that is not there gains more than 3.84 in 5 % of cases, 10 +- 10.
  for (const double truth : {0.3, 0.0}) {
    int covered = 0;
    int seen = 0;
    for (std::uint64_t i = 0; i < 200; ++i) {
      std::vector<double> values = white(3000, 47, i);
      std::vector<double> rate;
      for (double& value : values) {
        rate.push_back(static_cast<double>(rate.size()) / 2999.0);
        value *= 0.9 * std::sqrt(1.0 + truth * rate.back());
      }
      NoiseAtFullRate noise({values});
      noise.recordings[0].rate[2] = rate;
      const Modulation levels = modulation_of(
          noise.data, [](const StudyRecording& recording, std::size_t axis) { return &recording.rate.at(axis); });
      const ModulationFit fit = fit_modulation(levels, false, 1.0, raised);
      covered += fit.interval.low <= truth && truth <= fit.interval.high ? 1 : 0;
      seen += fit.gain > 3.84 ? 1 : 0;
    }
    EXPECT_GE(covered, 180) << truth;
    if (truth == 0.0) {
      EXPECT_LE(seen, 20);
    } else {
      EXPECT_GE(seen, 150);  // information (3000/2) var(u)/1.15^2: 2.9 standard deviations, seen in 83 %
    }
  }
}

TEST(Modulation, AnIntervalWidensByTheRootOfTheRepeatability) {
  NoiseAtFullRate noise({white(10, 1)});
  noise.data.repeatability = 4.0;
  ModulationFit fit;
  fit.value = 2.0;
  fit.interval = {1.5, 3.0};
  const Interval wide = widened(fit, noise.data);
  EXPECT_DOUBLE_EQ(wide.low, 1.0);
  EXPECT_DOUBLE_EQ(wide.high, 4.0);
}

}  // namespace
}  // namespace driftlab::investigate
