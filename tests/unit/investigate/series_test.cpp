/// Numbers that are worked out when they are asked for are those worked out beforehand.
#include "core/investigate/study/series.hpp"

#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

std::vector<double> numbers(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values(count);
  std::generate(values.begin(), values.end(), [&] { return 20.0 + random.normal(); });
  return values;
}

TEST(Series, AColumnIsInSiAndStaysWhereItIs) {
  std::vector<double> rows = numbers(50, 1);
  const Unit celsius = *parse_unit("degC");
  const Series series = Series::column(rows, celsius);
  ASSERT_EQ(series.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(series[i], celsius.to_si(rows[i])) << i;
  }
  rows[7] = 100.0;
  EXPECT_EQ(series[7], 373.15);
}

TEST(Series, DifferencesAreThoseOfVectorsToTheBit) {
  const std::vector<double> rows = numbers(40, 2);
  const std::vector<double> reference = numbers(40, 3);
  const Unit unit = *parse_unit("deg/s");
  const Series error = Series::column(rows, unit).minus(reference).minus(0.3);
  const Series again = error.minus(Series(reference).minus(0.1)).minus(-1e-3).minus(5.0);
  const Series still = Series::column(rows, unit).minus(Series::constant(0.0, rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double expected = unit.to_si(rows[i]);
    EXPECT_EQ(still[i], expected) << i;
    expected -= reference[i];
    expected -= 0.3;
    EXPECT_EQ(error[i], expected) << i;
    expected -= reference[i] - 0.1;
    expected -= -1e-3;
    expected -= 5.0;
    EXPECT_EQ(again[i], expected) << i;
  }
}

TEST(Series, PartsAndEveryOtherPlaceAreThoseOfTheWhole) {
  const std::vector<double> rows = numbers(41, 4);
  const Series whole = Series::view(rows).minus(numbers(41, 5)).minus(2.0);
  const std::vector<double> all = whole.values();
  const Series part = whole.part(10, 20).part(3, 5);
  EXPECT_EQ(part.values(), std::vector<double>(all.begin() + 13, all.begin() + 18));
  EXPECT_EQ(std::vector<double>(part.begin(), part.end()), part.values());
  EXPECT_EQ(whole.thinned(10, 2).values(), (std::vector<double>{all[2], all[12], all[22], all[32]}));
  EXPECT_EQ(whole.thinned(20, 0).size(), 3U);
  EXPECT_TRUE(whole.thinned(3, 50).empty());
  EXPECT_TRUE(Series().empty());
}

TEST(Series, CopiesKeepTheirNumbersWhenTheOriginalGoes) {
  Series copy;
  {
    const Series original(numbers(10, 6));
    copy = original.part(2, 3);
  }
  const std::vector<double> expected = numbers(10, 6);
  EXPECT_EQ(copy.values(), std::vector<double>(expected.begin() + 2, expected.begin() + 5));
}

TEST(Presence, HoldsNothingWhereEverySampleIsThere) {
  const Presence all(5);
  EXPECT_EQ(all.absent(), 0U);
  EXPECT_EQ(all.places(), std::vector<unsigned char>(5, 1));
  const Presence some(std::vector<unsigned char>{1, 0, 1, 0, 0});
  EXPECT_EQ(some.absent(), 3U);
  EXPECT_EQ(some[1], 0);
  EXPECT_EQ(some.thinned(2, 0).places(), (std::vector<unsigned char>{1, 1, 0}));
  EXPECT_EQ(all.thinned(2, 1).size(), 2U);
}

TEST(RunningVariance, IsThatOfEachWindowWhereverItLies) {
  const std::vector<double> values = numbers(300, 7);
  for (const double window : {2.0, 20.0, 1000.0}) {
    const std::vector<double> variance = running_variance(values, window);
    ASSERT_EQ(variance.size(), values.size());
    const auto half = static_cast<std::ptrdiff_t>(0.5 * window);
    for (std::ptrdiff_t i = 0; i < 300; ++i) {
      const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, i - half);
      const std::ptrdiff_t to = std::min<std::ptrdiff_t>(300, i + half);
      double mean = 0.0;
      double square = 0.0;
      for (std::ptrdiff_t k = from; k < to; ++k) {
        mean += values[static_cast<std::size_t>(k)] / static_cast<double>(to - from);
      }
      for (std::ptrdiff_t k = from; k < to; ++k) {
        square += std::pow(values[static_cast<std::size_t>(k)] - mean, 2.0) / static_cast<double>(to - from);
      }
      // Running sums of 300 squares of about one, of which each is rounded to 2^-53 of the sum.
      ASSERT_NEAR(variance[static_cast<std::size_t>(i)], square, 300.0 * 300.0 * std::ldexp(1.0, -53))
          << window << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace driftlab::investigate
