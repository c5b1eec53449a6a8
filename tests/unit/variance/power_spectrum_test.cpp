#include "core/variance/power_spectrum.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stop_token>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<double> draw(const Model& model, std::size_t samples, std::uint64_t run) {
  Random random(71, run);
  return simulate(model, random, kDt, samples);
}

TEST(PowerSpectrum, IntegratesToTheVarianceOfTheRecord) {
  // Five tapers weigh the samples almost evenly; white noise of 20,000 samples has its variance within 1 %.
  const std::vector<double> x = draw({*make_process("white_noise", {0.3})}, 20000, 0);
  const PowerSpectrum found = power_spectrum(x, 0.0, kDt);
  double integral = 0.0;
  for (std::size_t i = 0; i + 1 < found.density.size(); ++i) {
    integral += 0.5 * (found.density[i] + found.density[i + 1]) * (found.frequency_hz[i + 1] - found.frequency_hz[i]);
  }
  const double power = std::inner_product(x.begin(), x.end(), x.begin(), 0.0) / 20000.0;
  EXPECT_NEAR(integral, power, 0.03 * power);
  EXPECT_LT(found.frequency_hz.back(), 50.0);
  EXPECT_LT(found.frequency_hz.front(), 0.01);
}

TEST(PowerSpectrum, IntervalsCoverTheDensityOfEveryProcess) {
  // 200 records of 4,000 samples; over all bins of two octaves above the resolution the coverage is a mean of
  // thousands.
  for (const Model& model :
       {Model{*make_process("white_noise", {1.0})}, Model{*make_process("random_walk", {1.0})},
        Model{*make_process("gauss_markov", {1.0, 5.0})}, Model{*make_process("quantization_noise", {1.0})}}) {
    double covered = 0.0;
    double bins = 0.0;
    double mean = 0.0;
    for (std::uint64_t run = 0; run < 200; ++run) {
      const PowerSpectrum found = power_spectrum(draw(model, 4000, run), 0.0, kDt);
      for (std::size_t i = 0; i < found.density.size(); ++i) {
        if (found.frequency_hz[i] > 0.2 && found.frequency_hz[i] < 45.0) {
          const double truth = 2.0 * *model[0].spectral_density(found.frequency_hz[i], kDt);
          covered += found.ci95[i].contains(truth) ? 1.0 : 0.0;
          mean += found.density[i] / truth;
          bins += 1.0;
        }
      }
    }
    EXPECT_NEAR(mean / bins, 1.0, 0.02) << model[0].kind->symbol;
    EXPECT_GT(covered / bins, 0.93) << model[0].kind->symbol;
    EXPECT_LT(covered / bins, 0.97) << model[0].kind->symbol;
  }
}

TEST(PowerSpectrum, FindsASinusoidWithItsAmplitudeAndNoOther) {
  int false_lines = 0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    std::vector<double> x =
        draw({*make_process("white_noise", {0.1}), *make_process("random_walk", {0.05})}, 30000, run);
    false_lines += static_cast<int>(power_spectrum(x, 0.0, kDt).lines.size());
    for (std::size_t t = 0; t < x.size(); ++t) {  // at a tenth of the noise's deviation
      x[t] += 0.1 * std::sin(2.0 * std::numbers::pi * 7.3 * kDt * static_cast<double>(t));
    }
    const PowerSpectrum found = power_spectrum(x, 0.0, kDt);
    ASSERT_FALSE(found.lines.empty()) << run;
    const SpectrumLine strongest =
        *std::max_element(found.lines.begin(), found.lines.end(),
                          [](const SpectrumLine& a, const SpectrumLine& b) { return a.excess < b.excess; });
    EXPECT_NEAR(strongest.frequency_hz, 7.3, 1.0 / 300.0) << run;
    // Between two Fourier frequencies the first taper loses up to a fifth; noise adds a tenth.
    EXPECT_NEAR(strongest.amplitude, 0.1, 0.035) << run;
  }
  EXPECT_LE(false_lines, 2);  // 0.2 expected
}

TEST(PowerSpectrum, SaysNothingOfShortRecordsAndStopsWhenAsked) {
  const std::vector<double> x = draw({*make_process("white_noise", {1.0})}, 1000, 1);
  EXPECT_TRUE(power_spectrum(std::span(x).first(63), 0.0, kDt).density.empty());
  std::stop_source source;
  source.request_stop();
  EXPECT_TRUE(power_spectrum(x, 0.0, kDt, {.stop = source.get_token(), .progress = {}}).density.empty());
}

}  // namespace
}  // namespace driftlab
