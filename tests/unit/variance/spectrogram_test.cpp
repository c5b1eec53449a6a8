#include "core/variance/spectrogram.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

TEST(Spectrogram, ShowsWhenALineCameAndIsTheDensityElsewhere) {
  // White noise of density 1; a sinusoid of 12 Hz stands in its second half only.
  Random random(23, 0);
  std::vector<double> x = simulate({*make_process("white_noise", {1.0})}, random, kDt, 65536);
  for (std::size_t t = x.size() / 2; t < x.size(); ++t) {
    x[t] += 10.0 * std::sin(2.0 * std::numbers::pi * 12.0 * kDt * static_cast<double>(t));
  }
  const Spectrogram found = spectrogram(x, 0.0, kDt, 32, 40);
  ASSERT_EQ(found.time_s.size(), 32U);
  const std::size_t bands = found.frequency_hz.size();
  ASSERT_EQ(found.density.size(), 32 * bands);
  std::size_t line = 0;
  for (std::size_t b = 0; b < bands; ++b) {
    line = std::abs(found.frequency_hz[b] - 12.0) < std::abs(found.frequency_hz[line] - 12.0) ? b : line;
  }
  for (std::size_t cell = 0; cell < 32; ++cell) {
    EXPECT_EQ(found.density[cell * bands + line] > 3.0, cell >= 16) << cell;
  }
  double mean = 0.0;
  for (std::size_t cell = 0; cell < 16; ++cell) {
    mean += found.density[cell * bands + bands - 1] / 16.0;
  }
  EXPECT_NEAR(mean, 1.0, 0.05);
}

TEST(Spectrogram, OfAShortRecordHasFewerCells) {
  // 100 samples make three cells of 32, none shorter; 63 make nothing.
  Random random(23, 1);
  const std::vector<double> x = simulate({*make_process("white_noise", {1.0})}, random, kDt, 100);
  const Spectrogram found = spectrogram(x, 0.0, kDt, 256, 64);
  EXPECT_EQ(found.time_s.size(), 3U);
  EXPECT_EQ(found.window_samples, 32U);
  EXPECT_TRUE(spectrogram(std::span(x).first(63), 0.0, kDt, 8, 8).density.empty());
}

}  // namespace
}  // namespace driftlab
