#include "core/variance/binned_spectrum.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<double> draw(const Model& model, std::size_t samples, std::uint64_t run) {
  Random random(19, run);
  return simulate(model, random, kDt, samples);
}

TEST(BinnedSpectrum, IsTheTwoSidedDensityOfEveryProcessOnEitherScale) {
  // A figure lays the model's density over the measured one: both must be the same quantity. 100 records of 4,000
  // samples; intervals of 95 % cover the truth in 93 to 97 % of the bins in which it is nearly even.
  for (const Model& model : {Model{*make_process("white_noise", {1.0})}, Model{*make_process("random_walk", {1.0})},
                             Model{*make_process("gauss_markov", {1.0, 5.0})}}) {
    for (const FrequencyScale scale : {FrequencyScale::Log, FrequencyScale::Linear}) {
      double covered = 0.0;
      double bins = 0.0;
      for (std::uint64_t run = 0; run < 100; ++run) {
        const BinnedSpectrum found = binned_spectrum(draw(model, 4000, run), 0.0, kDt, scale, 120);
        for (std::size_t i = 0; i < found.density.size(); ++i) {
          if (found.frequency_hz[i] > 1.0 && found.frequency_hz[i] < 45.0) {
            covered += found.ci95[i].contains(*model[0].spectral_density(found.frequency_hz[i], kDt)) ? 1.0 : 0.0;
            bins += 1.0;
          }
        }
      }
      EXPECT_GT(covered / bins, 0.93) << model[0].kind->symbol;
      EXPECT_LT(covered / bins, 0.97) << model[0].kind->symbol;
    }
  }
}

TEST(BinnedSpectrum, KeepsALineThatTheMeanOfItsBinHides) {
  // A sinusoid of a fiftieth of the noise's variance, in 20 wide bins: the mean of its bin rises by a few per cent, the
  // greatest ordinate stands alone. The first taper gives a^2 n dt/4 of the sinusoid, 0.81 of it spread over five: some
  // 70 times the greatest of 2500 ordinates of noise.
  std::vector<double> x = draw({*make_process("white_noise", {0.1})}, 100000, 1);
  for (std::size_t t = 0; t < x.size(); ++t) {
    x[t] += 0.2 * std::sin(2.0 * std::numbers::pi * 17.3 * kDt * static_cast<double>(t));
  }
  const BinnedSpectrum found = binned_spectrum(x, 0.0, kDt, FrequencyScale::Linear, 20);
  ASSERT_EQ(found.density.size(), 20U);
  const auto most = std::max_element(found.greatest.begin(), found.greatest.end());
  const auto bin = static_cast<std::size_t>(most - found.greatest.begin());
  EXPECT_EQ(bin, 6U);  // 15 to 17.5 Hz
  EXPECT_GT(*most, 40.0 * found.greatest[bin + 1]);
  EXPECT_LT(found.density[bin], 2.0 * found.density[bin + 1]);
}

TEST(BinnedSpectrum, AveragesSegmentsOfALongRecordAndSaysSo) {
  // A record of 2.5 segments is read at its beginning and its end; its level is known better for it.
  const std::vector<double> x = draw({*make_process("white_noise", {1.0})}, std::size_t{5} << 19U, 2);
  const BinnedSpectrum found = binned_spectrum(x, 0.0, kDt, FrequencyScale::Log, 60);
  EXPECT_EQ(found.segments, 2U);
  EXPECT_LE(found.segment_samples, std::size_t{1} << 20U);
  EXPECT_NEAR(found.density.back(), 1.0, 0.01);
  EXPECT_GE(found.frequency_hz.front(), 1.0 / (static_cast<double>(std::size_t{1} << 20U) * kDt) * 0.99);
  EXPECT_TRUE(binned_spectrum(std::span(x).first(63), 0.0, kDt, FrequencyScale::Log, 60).density.empty());
}

}  // namespace
}  // namespace driftlab
