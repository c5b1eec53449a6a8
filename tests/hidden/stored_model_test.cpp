/// The stored extension once claimed what it did not hold: with an automatic baseline and an effect on the variance it
/// kept the white level that the effect had raised, and was worse on fresh data than the baseline (-88 nat of 176).
#include "tests/hidden/stored_gain.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <tuple>

namespace driftlab::hidden {
namespace {

class StoredModel : public testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(StoredModel, IsWorthOnFreshDataWhatTheTruthIsWorth) {
  const auto [cause, given] = GetParam();
  const StoredGain gain = stored_gain(cause, 30.0, 2030, given);
  EXPECT_TRUE(gain.named) << "said " << gain.said;
  EXPECT_TRUE(holds_its_promise(gain)) << gain.stored << " nat of " << gain.attainable << ", claimed " << gain.claimed;
}

/// One cause for each way in which an effect can change what the base holds.
INSTANTIATE_TEST_SUITE_P(Causes, StoredModel,
                         testing::Combine(testing::Values("rate_dependent_noise", "white_noise_level",
                                                          "noise_level_change", "outliers", "scale_factor_error"),
                                          testing::Bool()),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) +
                                  (std::get<1>(instance.param) ? "_given" : "_automatic");
                         });

}  // namespace
}  // namespace driftlab::hidden
