/// Is it one noise? Jumps and changes of level are found with their times; stationary noise of every kind passes.
#include "core/fit/stationarity.hpp"

#include "core/fit/characterise.hpp"
#include "core/process/model.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<double> white(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values(count);
  for (double& value : values) {
    value = random.normal();
  }
  return values;
}

TEST(Stationarity, FindsAJumpAndItsTime) {
  // A jump of 50 standard deviations in the middle of 50,000 samples was fitted as WN+GM with a J-test of p = 0.97.
  for (const double size : {50.0, -5.0, 2.0}) {
    std::vector<double> x = white(50000, 71);
    for (std::size_t i = 21234; i < x.size(); ++i) {
      x[i] += size;
    }
    const Stationarity found = test_stationarity(x, 0.01);
    ASSERT_EQ(found.changes.size(), 1U) << size;
    EXPECT_EQ(found.changes[0].kind, NoiseChange::Kind::Jump);
    EXPECT_NEAR(static_cast<double>(found.changes[0].sample), 21234.0, size == 2.0 ? 20.0 : 3.0);
    // Differences of means of 48 samples and more: 0.2 standard deviations.
    EXPECT_NEAR(found.changes[0].size, size, 0.8);
    EXPECT_EQ(found.first, found.changes[0].sample);
    EXPECT_EQ(found.last, 50000U);
  }
}

TEST(Stationarity, FindsAChangeOfLevelByAFifth) {
  std::vector<double> x = white(50000, 72);
  for (std::size_t i = 30000; i < x.size(); ++i) {
    x[i] *= 1.2;
  }
  const Stationarity found = test_stationarity(x, 0.01);
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_EQ(found.changes[0].kind, NoiseChange::Kind::Level);
  EXPECT_NEAR(static_cast<double>(found.changes[0].sample), 30000.0, 2000.0);
  EXPECT_NEAR(found.changes[0].size, 1.2, 0.03);
  EXPECT_EQ(found.first, 0U);
}

TEST(Stationarity, FindsSeveralChangesAndTheLongestPartBetween) {
  std::vector<double> x = white(60000, 73);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = (i < 10000 ? 2.0 * x[i] : x[i]) + (i >= 45000 ? 30.0 : 0.0);
  }
  const Stationarity found = test_stationarity(x, 0.01);
  ASSERT_EQ(found.changes.size(), 2U);
  EXPECT_EQ(found.changes[0].kind, NoiseChange::Kind::Level);
  EXPECT_EQ(found.changes[1].kind, NoiseChange::Kind::Jump);
  EXPECT_NEAR(static_cast<double>(found.first), 10000.0, 500.0);
  EXPECT_NEAR(static_cast<double>(found.last), 45000.0, 3.0);
  EXPECT_THAT(describe(found, 0.01), Contains(HasSubstr("450 s after the first sample; a model of the whole")));
}

TEST(Stationarity, IsSilentAboutNoiseThatWandersAndAboutGrossErrors) {
  const std::vector<std::pair<const char*, std::vector<double>>> parts{
      {"white_noise", {0.1}}, {"gauss_markov", {1.0, 1.7}}, {"random_walk", {0.05}}};
  for (std::uint64_t run = 0; run < 5; ++run) {
    Random random(74, run);
    Model model;
    for (const auto& [name, values] : parts) {
      model.push_back(*make_process(name, values));
    }
    EXPECT_TRUE(test_stationarity(simulate(model, random, 0.01, 40000), 0.01).changes.empty()) << run;
    EXPECT_TRUE(
        test_stationarity(simulate({*make_process("random_walk", {1.0})}, random, 0.01, 40000), 0.01).changes.empty());
    std::vector<double> spoilt = white(40000, 75 + run);
    for (double& value : spoilt) {
      value += random.uniform() < 0.01 ? 50.0 * random.normal() : 0.0;
    }
    for (std::size_t i = 10000; i < 10010; ++i) {
      spoilt[i] += 50.0;
    }
    EXPECT_TRUE(test_stationarity(spoilt, 0.01).changes.empty()) << run;
    std::vector<double> lattice = white(40000, 85 + run);
    for (double& value : lattice) {
      value = std::round(0.4 * value);
    }
    EXPECT_TRUE(test_stationarity(lattice, 0.01).changes.empty()) << run;
  }
}

TEST(Stationarity, DoesNotTestWhatIsTooShortOrConstant) {
  EXPECT_FALSE(test_stationarity(white(1499, 76), 0.01).tested);
  EXPECT_TRUE(test_stationarity(std::vector<double>(5000, 1.0), 0.01).changes.empty());
  EXPECT_TRUE(describe(test_stationarity(white(1499, 76), 0.01), 0.01).empty());
}

TEST(Stationarity, IsSaidOfACharacterisedChannelInItsUnit) {
  std::vector<double> x = white(20000, 77);
  for (std::size_t i = 12000; i < x.size(); ++i) {
    x[i] += 50.0;
  }
  CharacteriseOptions options;
  options.models = {"WN+GM"};
  options.dynamic = 9;
  const auto found = characterise_channel({.values = x, .dt_s = 0.01, .si_factor = 0.5}, options);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->stationarity.changes.size(), 1U);
  EXPECT_NEAR(found->stationarity.changes[0].size, 25.0, 0.5);
  EXPECT_THAT(found->warnings, Contains(HasSubstr("the level jumps 120")));
  // Windows of 4,000 samples, every 2,000: white noise of 0.5 units in each, to 3.5 standard errors of sqrt(3/n).
  ASSERT_TRUE(found->dynamic_allan);
  ASSERT_EQ(found->dynamic_allan->variance.size(), 9U);
  EXPECT_DOUBLE_EQ(found->dynamic_allan->window_s, 40.0);
  EXPECT_DOUBLE_EQ(found->dynamic_allan->start_s[8], 160.0);
  EXPECT_NEAR(found->dynamic_allan->variance[0][0], 0.25, 0.25 * 3.5 * std::sqrt(3.0 / 4000.0));
  options.dynamic = 1;
  EXPECT_EQ(check_options(options).error().fields.at(0).value, "dynamic");
}

TEST(Stationarity, TellsItsSamplesAsTimes) {
  Stationarity found;
  found.changes = {{NoiseChange::Kind::Jump, 150, 1.0, 2.0, 9.0}};
  found.first = 150;
  found.last = 400;
  EXPECT_DOUBLE_EQ(found.changes.front().time_s(0.02), 3.0);
  EXPECT_DOUBLE_EQ(found.first_s(0.02), 3.0);
  EXPECT_DOUBLE_EQ(found.last_s(0.02), 8.0);
}

}  // namespace
}  // namespace driftlab
