#include "core/variance/welch.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kLength = 256;

/// An offset, a slope and a sinusoid of `bin` periods in the piece.
std::vector<double> piece_with_line(double amplitude, std::size_t bin, PieceLine line) {
  std::vector<double> x(kLength);
  for (std::size_t t = 0; t < kLength; ++t) {
    const auto at = static_cast<double>(t);
    x[t] = line.level + line.slope * at +
           amplitude * std::cos(2.0 * std::numbers::pi * static_cast<double>(bin) * at / static_cast<double>(kLength));
  }
  return x;
}

TEST(WelchPeriodogram, ASinusoidOfAWholeNumberOfPeriodsIsItsClosedForm) {
  // |sum w x|^2 = (A/2 L/2)^2 at the frequency itself and (A/2 L/4)^2 at either side; sum w^2 = 3 L/8. The transform
  // rounds to some L eps of the greatest ordinate.
  constexpr double kAmplitude = 3.0;
  constexpr std::size_t kBin = 20;
  const PieceLine line{7.0, 0.02};
  WelchPeriodogram periodogram(kLength, Taper::Hann, kDt);
  for (int i = 0; i < 3; ++i) {
    periodogram.add(piece_with_line(kAmplitude, kBin, line), line);
  }
  EXPECT_EQ(periodogram.pieces(), 3U);
  const std::vector<double> density = periodogram.mean();
  ASSERT_EQ(density.size(), kLength / 2 + 1);
  const double peak = kAmplitude * kAmplitude * static_cast<double>(kLength) * kDt / 6.0;
  for (std::size_t k = 0; k < density.size(); ++k) {
    const double expected = k == kBin ? peak : k + 1 == kBin || k == kBin + 1 ? 0.25 * peak : 0.0;
    EXPECT_NEAR(density[k], expected, 1e-12 * peak) << k;
  }
}

TEST(WelchPeriodogram, WithoutAWindowItsSumIsTheMeanSquare) {
  // Parseval: the ordinates of all L frequencies, of which those between 0 and the middle stand for two, add up to the
  // sum of squares.
  Random random(61, 0);
  std::vector<double> x(kLength);
  double square = 0.0;
  for (double& value : x) {
    value = random.normal();
    square += value * value / static_cast<double>(kLength);
  }
  WelchPeriodogram periodogram(kLength, Taper::None, kDt);
  periodogram.add(x, {});
  const std::vector<double> density = periodogram.mean();
  double power = density.front() + density.back();
  for (std::size_t k = 1; k + 1 < density.size(); ++k) {
    power += 2.0 * density[k];
  }
  EXPECT_NEAR(power / (static_cast<double>(kLength) * kDt), square, 1e-13 * square);
}

TEST(WelchPeriodogram, WhiteNoiseHasItsDensityAndTheScatterOfItsDegreesOfFreedom) {
  // 800 pieces that overlap by half: nu = 36 K^2/(19 K - 1) = 1516 degrees of freedom at each frequency, so the
  // relative variance of an ordinate is 2/nu. Of 125 frequencies, which are correlated with their neighbours (2/3 of
  // the amplitude), the mean square deviation scatters by some sqrt(2/125 * 1.9) = 17 %, three of which are allowed.
  constexpr double kN = 0.3;
  constexpr std::size_t kPieces = 800;
  Random random(62, 0);
  const std::vector<double> x =
      simulate({*make_process("white_noise", {kN})}, random, kDt, kLength / 2 * (kPieces + 1));
  WelchPeriodogram periodogram(kLength, Taper::Hann, kDt);
  for (std::size_t w = 0; w < kPieces; ++w) {
    periodogram.add(std::span(x).subspan(w * kLength / 2, kLength), {});
  }
  const std::vector<double> density = periodogram.mean();
  constexpr double kFreedom = 36.0 * kPieces * kPieces / (19.0 * kPieces - 1.0);
  double mean = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t k = 2; k + 2 < density.size(); ++k) {
    const double off = density[k] / (kN * kN) - 1.0;
    mean += off;
    square += off * off;
    count += 1.0;
  }
  EXPECT_NEAR(mean / count, 0.0, 3.0 * std::sqrt(2.0 / kFreedom * 2.0 / count));
  EXPECT_NEAR(square / count / (2.0 / kFreedom), 1.0, 0.51);
}

TEST(WelchPeriodogram, BeforeItsFirstPieceThereIsNothing) {
  const WelchPeriodogram periodogram(64, Taper::Hann, kDt);
  const std::vector<double> density = periodogram.mean();
  EXPECT_EQ(density.size(), 33U);
  EXPECT_EQ(std::accumulate(density.begin(), density.end(), 0.0), 0.0);
}

}  // namespace
}  // namespace driftlab
