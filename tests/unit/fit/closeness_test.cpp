// A fit was plausible or not and nothing said how far it was from the closest; of the first of a ranking it was a
// riddle.
#include "core/fit/closeness.hpp"

#include "core/fit/characterise.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab {
namespace {

// White noise alone, and white noise with a change of its level that no candidate describes, so that both readings of
// the criterion's N are met.
TEST(Closeness, IsWhatThePlausibleSetIsMadeOf) {
  for (const bool changes : {false, true}) {
    Random random(11);
    std::vector<double> values(20000);
    double walk = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      walk += changes && i > 9000 && i < 9400 ? 0.3 * random.normal() : 0.0;
      values[i] = random.normal() + walk;
    }
    const auto found = characterise_channel({values, 0.01, 1.0, {}}, {});
    ASSERT_TRUE(found) << found.error().message;
    std::vector<RankedModel> models;
    for (const ModelFit& fit : found->fits) {
      models.push_back({fit.model, fit.wic});
    }
    const double n = criterion_observations(found->samples, found->discrepancy, found->haar.scale.size());
    const auto distances = distances_2p(models, n);
    ASSERT_EQ(distances.size(), found->fits.size());
    EXPECT_EQ(std::count(distances.begin(), distances.end(), std::optional<double>(0.0)), 1);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      ASSERT_TRUE(distances[i]);
      EXPECT_EQ(found->fits[i].distance_2p, distances[i]) << "a fit says its own";
      EXPECT_EQ(found->fits[i].closest(), distances[i] && *distances[i] <= 0.0) << "none is closer than the least";
      EXPECT_EQ(*distances[i] <= 6.0, found->fits[i].plausible) << found->fits[i].model << " " << *distances[i];
    }
  }
}

TEST(Closeness, CountsTheScalesFromATauThatIsWrittenInDecimals) {
  const std::vector<std::size_t> scale{2, 4, 8, 16};
  EXPECT_EQ(fitted_scales(scale, 0.01, 0.0), 4U);
  EXPECT_EQ(fitted_scales(scale, 0.01, 0.02), 3U);  // 2 samples of 0.01 s are 0.02 s
  EXPECT_EQ(fitted_scales(scale, 0.1 / 3.0, 0.0333333333333 * 2.0), 3U) << "one digit in 1e12 less";
  EXPECT_EQ(fitted_scales(scale, 0.01, 0.021), 2U);
  EXPECT_EQ(fitted_scales(scale, 0.01, 1.0), 0U);
}

TEST(Closeness, SaysNothingOfWhatWasNotRanked) {
  const std::vector<RankedModel> models{{"WN", 10.0}, {"nothing", 1.0}, {"WN+GM", INFINITY}};
  const auto distances = distances_2p(models, 100.0);
  EXPECT_EQ(distances[0], 0.0);
  EXPECT_FALSE(distances[1]);
  EXPECT_FALSE(distances[2]);
}

}  // namespace
}  // namespace driftlab
