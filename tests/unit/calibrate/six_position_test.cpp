#include "core/calibrate/six_position.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace driftlab {
namespace {

constexpr double kG = 9.80665;

/// A triad with known faults.
const TriadLaw kTruth{{Triple{1.002, 0.003, -0.001}, Triple{-0.002, 0.997, 0.0015}, Triple{0.0005, -0.0025, 1.0005}},
                      {0.05, -0.08, 0.02}};

Triple read(const TriadLaw& law, const Triple& x) {
  Triple y{};
  for (std::size_t i = 0; i < 3; ++i) {
    y[i] = law.bias[i];
    for (std::size_t j = 0; j < 3; ++j) {
      y[i] += law.matrix[i][j] * x[j];
    }
  }
  return y;
}

/// The six positions of `law`, each mean off by `sigma` times a normal draw.
std::vector<KnownPosition> six(const TriadLaw& law, double sigma, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<KnownPosition> positions;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      KnownPosition position;
      position.truth[axis] = sign * kG;
      position.reading.mean = read(law, position.truth);
      for (std::size_t i = 0; i < 3; ++i) {
        position.reading.mean[i] += sigma * normal(random);
        position.reading.sigma[i] = sigma;
      }
      positions.push_back(position);
    }
  }
  return positions;
}

TEST(SixPosition, GivesBiasAndScaleOfEquationsNineAndTen) {
  // One up, one down: b = (u + d)/2, S = (u - d)/(2 g) - 1.
  const auto found = calibrate_six_positions(six(kTruth, 0.0, 1));
  ASSERT_TRUE(found) << found.error().message;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found->bias[i].value, kTruth.bias[i], 1e-13);
    EXPECT_NEAR(found->scale_factor[i].value, kTruth.matrix[i][i] - 1.0, 1e-14);
    EXPECT_FALSE(found->misalignment[i][(i + 1) % 3]);
  }
  EXPECT_EQ(found->readings, 6U);
  EXPECT_TRUE(std::isinf(found->bias[0].ci95.high));  // no uncertainty is stated and none is left to scatter
  EXPECT_EQ(found->chi_square_per_dof, 0.0);
  EXPECT_LT(found->residual_after, found->residual_before);
}

TEST(SixPosition, FindsAllTwelveNumbers) {
  const auto found = calibrate_six_positions(six(kTruth, 0.0, 1), {.misalignment = true});
  ASSERT_TRUE(found) << found.error().message;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found->bias[i].value, kTruth.bias[i], 1e-13);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(found->law.matrix[i][j], kTruth.matrix[i][j], 1e-14);
    }
  }
  EXPECT_LT(found->residual_after, 1e-13);
}

TEST(SixPosition, CorrectsReadingsBackToTheTruth) {
  const Triple x{1.0, -2.0, 9.5};
  const Triple back = kTruth.correct(read(kTruth, x));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(back[i], x[i], 1e-13);
  }
}

TEST(SixPosition, CalibratesGyroscopesByKnownRates) {
  std::vector<KnownPosition> turns = six(kTruth, 0.0, 1);
  const double rate = 1.5;
  for (KnownPosition& turn : turns) {
    for (double& value : turn.truth) {
      value *= rate / kG;
    }
    turn.reading.mean = read(kTruth, turn.truth);
  }
  const auto found = calibrate_six_positions(turns);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->scale_factor[1].value, -0.003, 1e-13);
  EXPECT_NEAR(found->bias[2].value, 0.02, 1e-13);
}

TEST(SixPosition, IntervalsHoldTheTruthInNinetyFivePercent) {
  // 2000 tests of 12 numbers: the standard error of a coverage of 24000 is 0.14 %, of correlated ones below 0.5 %.
  for (const bool misalignment : {false, true}) {
    int inside = 0;
    int all = 0;
    for (std::uint64_t run = 0; run < 2000; ++run) {
      const auto found = calibrate_six_positions(six(kTruth, 0.002, 100 + run), {misalignment});
      ASSERT_TRUE(found);
      for (std::size_t i = 0; i < 3; ++i) {
        inside += found->bias[i].ci95.contains(kTruth.bias[i]) ? 1 : 0;
        inside += found->scale_factor[i].ci95.contains(kTruth.matrix[i][i] - 1.0) ? 1 : 0;
        all += 2;
        for (std::size_t j = 0; j < 3 && misalignment; ++j) {
          const auto& angle = found->misalignment[i][j];
          ASSERT_EQ(angle.has_value(), j != i);
          inside += angle && angle->ci95.contains(kTruth.matrix[i][j]) ? 1 : 0;
          all += angle ? 1 : 0;
        }
      }
    }
    // With axes, intervals widen where chance scatters more than the means say, and never narrow: a little above 95 %.
    const double coverage = static_cast<double>(inside) / all;
    EXPECT_GT(coverage, 0.94) << misalignment;
    EXPECT_LT(coverage, misalignment ? 0.985 : 0.96) << misalignment;
  }
}

TEST(SixPosition, WidensIntervalsForATableThatIsNotLevel) {
  std::vector<KnownPosition> positions = six(TriadLaw{}, 1e-4, 5);
  std::mt19937_64 random(9);
  std::normal_distribution<double> tilt(0.0, 0.002);
  for (KnownPosition& position : positions) {
    for (std::size_t i = 0; i < 3; ++i) {
      position.reading.mean[i] += position.truth[i] == 0.0 ? kG * tilt(random) : 0.0;
    }
  }
  const auto found = calibrate_six_positions(positions, {.misalignment = true});
  ASSERT_TRUE(found);
  EXPECT_GT(found->chi_square_per_dof, 100.0);
  EXPECT_GT(found->bias[0].ci95.high - found->bias[0].ci95.low, 100.0 * 1e-4);
}

TEST(SixPosition, NamesTheAxisThatLacksAPosition) {
  std::vector<KnownPosition> positions = six(kTruth, 0.0, 1);
  positions.erase(positions.begin() + 3);  // y down
  const auto found = calibrate_six_positions(positions);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::TooFewSamples);
  EXPECT_EQ(found.error().fields.at(0).value, "y");
}

TEST(TriadMean, GivesTheMeanAndItsUncertainty) {
  // 4000 samples of white noise of 0.5: sigma of the mean 0.0079; 20 batches know that within 16 % and add 6 %.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 0.5);
  std::array<std::vector<double>, 3> channels;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 4000; ++i) {
      channels[axis].push_back(1e6 + normal(random));
    }
  }
  const auto mean = triad_mean({channels[0], channels[1], channels[2]});
  ASSERT_TRUE(mean);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean->mean[axis], 1e6, 4.0 * 0.0079);
    EXPECT_NEAR(mean->sigma[axis], 1.06 * 0.0079, 4.0 * 0.16 * 0.0079);
  }
  EXPECT_FALSE(triad_mean({channels[0], channels[1], std::span<const double>(channels[2]).first(10)}));
}

}  // namespace
}  // namespace driftlab
