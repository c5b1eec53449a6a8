#include "core/variance/spectral_lines.hpp"

#include "core/process/model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

std::vector<double> noise(const Model& model, std::uint64_t seed, std::size_t samples = 90'000) {
  Random random(seed);
  return simulate(model, random, 0.01, samples);
}

TEST(SpectralLines, NoiseWithoutALineHasNone) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_TRUE(spectral_lines(noise({*make_process("white_noise", {0.1})}, seed), 0.0).empty()) << seed;
    EXPECT_TRUE(spectral_lines(
                    noise({*make_process("white_noise", {0.1}), *make_process("gauss_markov", {0.5, 2.0})}, seed), 0.0)
                    .empty())
        << seed;
    EXPECT_TRUE(spectral_lines(noise({*make_process("random_walk", {1.0})}, seed), 0.0).empty()) << seed;
  }
}

TEST(SpectralLines, SinusoidIsASharpLineAndAResonanceIsNot) {
  const std::vector<SpectralLine> line =
      spectral_lines(noise({*make_process("white_noise", {0.1}), *make_process("sinusoid", {0.3, 7.3})}, 1), 0.0);
  ASSERT_EQ(line.size(), 1U);
  EXPECT_NEAR(line[0].frequency, 0.073, 1.0 / 2048.0);
  EXPECT_TRUE(line[0].sharp);
  const std::vector<SpectralLine> bump = spectral_lines(
      noise({*make_process("white_noise", {0.1}), *make_process("resonance", {0.5, 20.0, 10.0})}, 1), 0.0);
  ASSERT_EQ(bump.size(), 1U);
  EXPECT_NEAR(bump[0].frequency, 0.2, 0.02) << "the width of the peak";
  EXPECT_FALSE(bump[0].sharp);
}

TEST(SpectralLines, ShortAndConstantSeriesHaveNone) {
  EXPECT_TRUE(spectral_lines(noise({*make_process("sinusoid", {0.3, 7.3})}, 1, 2000), 0.0).empty());
  EXPECT_TRUE(spectral_lines(std::vector<double>(10'000, 3.0), 3.0).empty());
}

}  // namespace
}  // namespace driftlab
