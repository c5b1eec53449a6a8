/// Filled gaps: a spectrum taken over them is that of the noise, white or coloured, at every frequency.
#include "core/investigate/fullrate/gaps.hpp"

#include "core/investigate/fullrate/spectrum.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kSamples = 120000;
constexpr double kDt = 0.01;
constexpr std::size_t kBeside = 200;

/// Gaps that begin at random and have a geometric length of mean six.
std::vector<unsigned char> some_used(double share, Random& random) {
  std::vector<unsigned char> used(kSamples, 1);
  for (std::size_t i = 0; i < kSamples; ++i) {
    if (random.uniform() < share / 6.0) {
      do {
        used[i++] = 0;
      } while (i < kSamples && random.uniform() > 1.0 / 6.0);
    }
  }
  return used;
}

/// Mean of power over what is expected, between two frequencies [Hz].
template <class Expected>
double ratio_between(const Spectrum& s, double low_hz, double high_hz, Expected expected) {
  double ratio = 0.0;
  double weight = 0.0;
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    if (s.f_hz[j] >= low_hz && s.f_hz[j] < high_hz) {
      ratio += s.weight[j] * s.power[j] / expected(s.f_hz[j]);
      weight += s.weight[j];
    }
  }
  return ratio / weight;
}

TEST(Gaps, NothingMissingLeavesTheValues) {
  const Series values(std::vector<double>{1.0, 2.0, 3.0});
  const FilledGaps filled = fill_gaps(values, {1, 1, 1}, kBeside);
  EXPECT_EQ(filled.values.values(), values.values());
  EXPECT_EQ(filled.broken, 0.0);
}

TEST(Gaps, FewSamplesStandOnALine) {
  std::vector<double> values(1000, 1.0);
  values[500] = 99.0;
  values[501] = -99.0;
  values[502] = 4.0;
  std::vector<unsigned char> used(1000, 1);
  used[500] = used[501] = 0;
  const FilledGaps filled = fill_gaps(values, used, kBeside);
  EXPECT_DOUBLE_EQ(filled.values[500], 2.0);
  EXPECT_DOUBLE_EQ(filled.values[501], 3.0);
  EXPECT_DOUBLE_EQ(filled.broken, 0.002);
}

TEST(Gaps, NothingButGapsIsFilledSomehow) {
  const FilledGaps filled = fill_gaps(std::vector<double>{1.0, 2.0, 3.0}, {0, 0, 0}, kBeside);
  EXPECT_EQ(filled.values.size(), 3U);
  EXPECT_EQ(filled.broken, 1.0);
}

TEST(Gaps, WhiteNoiseKeepsItsLevelAtEveryFrequency) {
  Random random(1);
  std::vector<double> values(kSamples);
  for (double& v : values) {
    v = 3.0 + random.normal();
  }
  const std::vector<unsigned char> used = some_used(0.1, random);
  for (std::size_t i = 0; i < kSamples; ++i) {
    values[i] = used[i] != 0 ? values[i] : 1e6;  // whatever stands in a gap is not looked at
  }
  const FilledGaps filled = fill_gaps(values, used, kBeside);
  const Spectrum s = estimate_spectrum(filled.values, kDt, 0.3);
  const auto white = [](double) { return kDt; };
  EXPECT_NEAR(ratio_between(s, 0.3, 2.0, white), 1.0, 0.05);  // 2,040 ordinates: 0.022
  for (double low = 2.0; low < 48.0; low += 8.0) {
    EXPECT_NEAR(ratio_between(s, low, low + 8.0, white), 1.0, 0.03) << low;  // 9,600 ordinates: 0.010
  }
  const double missing = static_cast<double>(std::count(used.begin(), used.end(), 0)) / kSamples;
  EXPECT_NEAR(filled.broken, missing / 3.0, 0.01);
}

TEST(Gaps, ColouredNoiseKeepsItsColourButForTheJoints) {
  // Differences of white noise: no power at frequency zero.
  Random random(2);
  std::vector<double> values(kSamples);
  double last = random.normal();
  for (double& v : values) {
    const double next = random.normal();
    v = next - last;
    last = next;
  }
  const std::vector<unsigned char> used = some_used(0.05, random);
  const FilledGaps filled = fill_gaps(values, used, kBeside);
  const Spectrum s = estimate_spectrum(filled.values, kDt, 0.3);
  const auto expected = [&](double f) {
    const double half = std::sin(std::numbers::pi * f * kDt);
    return kDt * (4.0 * half * half + 2.0 * filled.broken);
  };
  for (const double low : {1.0, 2.0, 4.0, 8.0, 16.0, 24.0}) {
    EXPECT_NEAR(ratio_between(s, low, 2.0 * low, expected), 1.0, low < 4.0 ? 0.3 : 0.1) << low;
  }
}

}  // namespace
}  // namespace driftlab::investigate
