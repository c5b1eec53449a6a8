#include "core/fit/bootstrap.hpp"

#include "core/fit/characterise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<double> series(std::size_t samples) {
  Random random(31);
  return simulate({*make_process("white_noise", {0.05}), *make_process("random_walk", {0.05})}, random, kDt, samples);
}

TEST(Bootstrap, RisesAreNearTheChiSquareWhereTheDataAreMany) {
  // The 95 % quantile of 400 chi-square(1) values has standard error sqrt(.95 .05/400)/f(3.84) = 0.0109/0.0298 = 0.37;
  // four of them around 3.84.
  const std::vector<double> x = series(9000);
  const auto plain = characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN+RW"}});
  const auto calibrated = characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN+RW"}, .bootstrap = 400});
  ASSERT_TRUE(plain && calibrated);
  EXPECT_EQ(plain->fits[0].intervals, "profile");
  EXPECT_EQ(calibrated->fits[0].intervals, "bootstrap");
  for (std::size_t p = 0; p < 2; ++p) {
    const Estimate& a = *plain->fits[0].processes[p].parameters[0].estimate;
    const Estimate& b = *calibrated->fits[0].processes[p].parameters[0].estimate;
    EXPECT_EQ(a.value, b.value);
    // Widths go with the root of the rise: within sqrt((3.84 +- 1.5)/3.84).
    const double ratio = std::log(b.ci95.high / b.ci95.low) / std::log(a.ci95.high / a.ci95.low);
    EXPECT_GT(ratio, 0.78) << p;
    EXPECT_LT(ratio, 1.18) << p;
    EXPECT_NE(ratio, 1.0) << p;
  }
}

TEST(Bootstrap, SameSeedSameBitsAndAnotherSeedOthers) {
  const std::vector<double> x = series(4000);
  const auto low = [&](std::uint64_t seed) {
    const auto found =
        characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN+RW"}, .seed = seed, .bootstrap = 40});
    return found->fits[0].processes[0].parameters[0].estimate->ci95.low;
  };
  EXPECT_EQ(low(1), low(1));
  EXPECT_NE(low(1), low(2));
}

TEST(Bootstrap, RefusesTooFewAndTooManyReplicates) {
  for (const std::size_t replicates : {std::size_t{1}, std::size_t{39}, std::size_t{2001}}) {
    const auto status = check_options({.bootstrap = replicates});
    ASSERT_FALSE(status.has_value());
    EXPECT_THAT(status.error().fields, testing::Contains(ErrorField{"parameter", "bootstrap"}));
  }
}

}  // namespace
}  // namespace driftlab
