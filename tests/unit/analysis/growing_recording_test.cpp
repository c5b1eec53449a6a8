#include "core/analysis/growing_recording.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<double> stamps(std::size_t samples) {
  std::vector<double> time(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    time[i] = 5.0 + static_cast<double>(i) * kDt;
  }
  return time;
}

TEST(GrowingRecording, ReadsWhiteNoiseOffAndSaysWhenTheNextPointComes) {
  // A minute of white noise, a hundred times: the interval of N holds it as often as 95 % allow.
  int covered = 0;
  for (std::uint64_t run = 0; run < 100; ++run) {
    Random random(41, run);
    const std::vector<double> x = simulate({*make_process("white_noise", {0.02})}, random, kDt, 6000);
    const GrowingRecording look = look_at_growth(stamps(6000), x);
    ASSERT_TRUE(look.n) << look.n_reason;
    covered += look.n->ci95.contains(0.02) ? 1 : 0;
    EXPECT_NEAR(*look.rate_hz, 100.0, 1e-6);
    EXPECT_EQ(look.gaps, 0U);
    EXPECT_DOUBLE_EQ(look.next_tau_s, 2.0 * look.tau_s.back());
    EXPECT_GT(look.next_in_s, 0.0);
  }
  EXPECT_GE(covered, 89);  // 95 of 100 less three standard deviations of a binomial share
}

TEST(GrowingRecording, ReadsNothingOffWhereTheSlopeIsAnother) {
  // A random walk rises with tau: no averaging time up to 1 s has the slope of white noise.
  Random random(41, 1000);
  const std::vector<double> x = simulate({*make_process("random_walk", {1.0})}, random, kDt, 6000);
  const GrowingRecording look = look_at_growth(stamps(6000), x);
  EXPECT_FALSE(look.n);
  EXPECT_NE(look.n_reason.find("slope"), std::string::npos);
}

TEST(GrowingRecording, CountsAGapAndDoesNotBridgeIt) {
  // Two seconds are missing after the first third: the deviation is that of the longer run, and the gap is counted.
  Random random(41, 2000);
  const std::vector<double> x = simulate({*make_process("white_noise", {1.0})}, random, kDt, 3000);
  std::vector<double> time = stamps(3000);
  for (std::size_t i = 1000; i < 3000; ++i) {
    time[i] += 2.0;
  }
  const GrowingRecording look = look_at_growth(time, x);
  EXPECT_EQ(look.gaps, 1U);
  EXPECT_LE(look.tau_s.back(), 10.0);
  EXPECT_FALSE(look_at_growth(std::span(time).first(2), std::span(x).first(2)).rate_hz);
}

TEST(GrowingRecording, TellsASensorAtRestFromOneInAHand) {
  Random random(41, 3000);
  const std::vector<double> noise = simulate({*make_process("white_noise", {0.0002})}, random, kDt, 500);
  std::vector<double> moved = noise;
  for (std::size_t i = 300; i < 500; ++i) {
    moved[i] += 0.5 * std::sin(static_cast<double>(i) * 0.05);
  }
  const Unit rate = parse_unit("rad/s").value();
  EXPECT_EQ(lies_still(stamps(500), noise, rate), true);
  EXPECT_EQ(lies_still(stamps(500), moved, rate), false);
  EXPECT_FALSE(lies_still(stamps(5), std::span(noise).first(5), rate));
  EXPECT_FALSE(lies_still(stamps(500), noise, parse_unit("degC").value()));
}

}  // namespace
}  // namespace driftlab
