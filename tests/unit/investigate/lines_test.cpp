#include "core/investigate/causes/lines.hpp"

#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDt = 0.02;

void add_line(std::vector<double>& values, double amplitude, double f_hz, double phase) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += amplitude * std::sin(2.0 * kPi * f_hz * static_cast<double>(i) * kDt + phase);
  }
}

/// White noise of unit variance with a line.
std::vector<double> with_line(std::size_t count, double amplitude, double f_hz, std::uint64_t stream) {
  std::vector<double> values = white(count, 53, stream);
  add_line(values, amplitude, f_hz, 0.7 * static_cast<double>(stream));
  return values;
}

TEST(Lines, AmplitudeAndFrequencyHaveTheIntervalsOfTheirBounds) {
  // Cramer-Rao bounds of a sinusoid in white noise of variance 1 (Rife and Boorstyn 1974): var A = 2/n and
  // var f = 6/(pi^2 A^2 n T^2). Of 100 intervals of 95 % at least 88 hold the truth (95 less 3.2 standard deviations).
  constexpr std::size_t kCount = 8000;
  constexpr double kAmplitude = 0.15;
  constexpr double kLength = kCount * kDt;
  const double sd = std::sqrt(2.0 / kCount);
  const double sd_f = std::sqrt(6.0 / kCount) / (kPi * kAmplitude * kLength);
  int amplitudes = 0;
  int frequencies = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const double f = 3.0 + 0.17 * static_cast<double>(i);
    const NoiseAtFullRate noise({with_line(kCount, kAmplitude, f, i)}, kDt);
    const Evidence found = line_near(noise.data, {0}, f, 0.1);
    const Estimate& amplitude = found.parameters[0].estimate;
    const Estimate& frequency = found.parameters[1].estimate;
    amplitudes += amplitude.ci95.low <= kAmplitude && kAmplitude <= amplitude.ci95.high ? 1 : 0;
    frequencies += frequency.ci95.low <= f && f <= frequency.ci95.high ? 1 : 0;
    // The density is a mean over some 60 ordinates near by: 13 %, of which the interval has the root.
    EXPECT_NEAR(amplitude.ci95.high - amplitude.value, 1.96 * sd, 4.0 * 0.065 * 1.96 * sd);
    EXPECT_NEAR(frequency.ci95.high - frequency.value, 1.96 * sd_f, 0.6 * 1.96 * sd_f);  // and the amplitude's error
  }
  EXPECT_GE(amplitudes, 88);
  EXPECT_GE(frequencies, 88);
}

TEST(Lines, TheScoreOfWhiteNoiseIsTheSurpriseOfItsLargestPeak) {
  // exp(-score/2) bounds the chance of such a peak anywhere in the record: a score above 4 in at most 13.5 % of
  // records, 41 of 300 with a standard deviation of 5.9. It is no loose bound: half of that are seen.
  int seen = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const NoiseAtFullRate noise({white(3000, 59, i)}, kDt);
    seen += find_lines(noise.data).empty() ? 0 : 1;
  }
  EXPECT_LE(seen, 41 + 24);
  EXPECT_GE(seen, 12);
}

TEST(Lines, ALineOfAllRecordingsIsFoundInAllOfThemWithItsFreePhases) {
  // n A^2/2 = 40 in each of three recordings; together 120 against the 2 ln(0.75 n) = 16 that the choice costs.
  std::vector<std::vector<double>> values;
  for (std::uint64_t r = 0; r < 3; ++r) {
    values.push_back(with_line(8000, 0.1, 7.3, r));
  }
  const NoiseAtFullRate noise(values, kDt);
  const std::vector<Evidence> found = find_lines(noise.data);
  ASSERT_FALSE(found.empty());
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const Evidence& a, const Evidence& b) { return a.score < b.score; });
  EXPECT_EQ(best->members, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_NEAR(best->shape, 7.3, 0.01);
  EXPECT_NEAR(best->parameters[0].estimate.value, 0.1, 4.0 * std::sqrt(2.0 / 24000.0));
  EXPECT_TRUE(best->note.empty());
}

TEST(Lines, ALineOfOneRecordingIsFoundInThatOne) {
  const NoiseAtFullRate noise({white(8000, 61), with_line(8000, 0.15, 11.0, 1), white(8000, 62)}, kDt);
  const std::vector<Evidence> found = find_lines(noise.data);
  ASSERT_FALSE(found.empty());
  const auto best = std::max_element(found.begin(), found.end(),
                                     [](const Evidence& a, const Evidence& b) { return a.score < b.score; });
  EXPECT_EQ(best->members, (std::vector<std::size_t>{1}));
  EXPECT_NEAR(best->shape, 11.0, 0.01);
}

TEST(Lines, ManyPeaksNearByAreNarrowBandNoise) {
  std::vector<double> values = white(8000, 67);
  for (const double f : {8.0, 8.4, 8.8, 9.2, 9.6}) {
    add_line(values, f == 8.8 ? 0.25 : 0.2, f, f);
  }
  const NoiseAtFullRate noise({values}, kDt);
  const std::vector<Evidence> found = find_lines(noise.data);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().score, 0.0);
  EXPECT_EQ(found.front().note, "narrow-band noise");
}

TEST(Lines, AFittedLineIsTheSinusoidInTheSamplesInUse) {
  // Least squares on a sinusoid without noise: the line itself, also where samples are out of use. The mean of the
  // whole record is taken off first, which for the broken period at the end is of order 1/n.
  std::vector<double> values(5000, 0.0);
  add_line(values, 0.8, 4.0, 1.1);  // 400 whole periods: its mean is 0
  NoiseAtFullRate noise({values}, kDt);
  std::fill_n(noise.data.used[0].begin() + 1000, 2000, static_cast<unsigned char>(0));
  const std::vector<double> line = fitted_line(noise.data, 0, 4.0);
  ASSERT_EQ(line.size(), values.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    ASSERT_NEAR(line[i], values[i], 1e-9);
  }
}

TEST(Lines, ARecordingWithoutASampleInUseSaysNothing) {
  NoiseAtFullRate noise({with_line(4000, 0.5, 5.0, 2)}, kDt);
  std::fill(noise.data.used[0].begin(), noise.data.used[0].end(), static_cast<unsigned char>(0));
  const std::vector<double> line = fitted_line(noise.data, 0, 5.0);
  EXPECT_TRUE(std::all_of(line.begin(), line.end(), [](double v) { return v == 0.0; }));
  EXPECT_EQ(line_gain(noise.data, {0}, 5.0, 0.5), 0.0);
}

TEST(Lines, TheGainOfAKnownLineIsTheLikelihoodRatioOverItsPhase) {
  // ln mean over phi of exp(sum y s - s^2/2) with s = A sin(w t + phi) and unit variance, by 400 phases. The product
  // knows the density only from ordinates near by, to 1/sqrt(193) = 7 %, which both of its terms carry: 4 times that.
  constexpr double kAmplitude = 0.05;
  for (const bool there : {true, false}) {
    const NoiseAtFullRate noise({with_line(25000, there ? kAmplitude : 0.0, 6.1, 3)}, kDt);
    double sine = 0.0;
    double cosine = 0.0;
    for (std::size_t i = 0; i < 25000; ++i) {
      const double angle = 2.0 * kPi * 6.1 * static_cast<double>(i) * kDt;
      sine += noise.data.residual[0][i] * std::sin(angle);
      cosine += noise.data.residual[0][i] * std::cos(angle);
    }
    double mean = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double phi = 2.0 * kPi * k / 400.0;
      mean += std::exp(kAmplitude * (sine * std::cos(phi) + cosine * std::sin(phi))) / 400.0;
    }
    const double fixed = 0.25 * kAmplitude * kAmplitude * 25000.0;
    const double expected = std::log(mean) - fixed;
    EXPECT_NEAR(line_gain(noise.data, {0}, 6.1, kAmplitude), expected, 4.0 * 0.07 * (std::fabs(expected) + fixed));
    EXPECT_EQ(expected > 0.0, there);
  }
}

}  // namespace
}  // namespace driftlab::investigate
