#include "core/variance/haar_variance.hpp"

#include "core/process/random.hpp"
#include "core/variance/allan_variance.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/prefix_sums.hpp"
#include "core/variance/robust_variance.hpp"
#include "core/variance/samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stop_token>
#include <vector>

namespace driftlab {
namespace {

std::vector<double> white(std::size_t n, std::uint64_t seed, double bias = 0.0) {
  Random random(seed);
  std::vector<double> x(n);
  for (double& value : x) {
    value = bias + random.normal();
  }
  return x;
}

/// The definition, term by term, in long double.
double by_definition(const std::vector<double>& x, std::size_t m) {
  long double sum = 0.0L;
  std::size_t count = 0;
  for (std::size_t end = 2 * m; end <= x.size(); ++end) {
    long double w = 0.0L;
    for (std::size_t i = 0; i < m; ++i) {
      w += x[end - 1 - i];
      w -= x[end - 1 - m - i];
    }
    w /= 2.0L * static_cast<long double>(m);
    sum += w * w;
    ++count;
  }
  return static_cast<double>(sum / static_cast<long double>(count));
}

HaarVariance variances(const std::vector<double>& x) { return haar_variance(x, summarise(x)->mean); }

TEST(HaarVariance, EqualsItsDefinitionAtEveryScale) {
  // Lengths around the block size, powers of two and one off them.
  for (const std::size_t n : {2U, 3U, 7U, 8U, 255U, 256U, 2047U, 2048U, 2049U, 4096U, 5000U}) {
    const std::vector<double> x = white(n, 7 + n);
    const HaarVariance curve = variances(x);
    for (std::size_t j = 0; j < curve.scales(); ++j) {
      const double expected = by_definition(x, curve.half[j]);
      EXPECT_NEAR(curve.variance[j], expected, 1e-13 * expected) << "n=" << n << " m=" << curve.half[j];
    }
  }
}

TEST(HaarVariance, FiltersBeyondTheWindowEqualTheirDefinition) {
  // Blocks older than 2^20 samples are made again from the samples: at the lengths where that begins, with the first
  // filter of all ending inside a block, at its end, and one sample behind it.
  for (const std::size_t n : {(std::size_t{1} << 22U) - 1, std::size_t{1} << 22U, (std::size_t{1} << 22U) + 1,
                              (std::size_t{1} << 22U) + 300007}) {
    const std::vector<double> x = white(n, n, 5.0);
    const double pivot = summarise(x)->mean;
    const HaarVariance curve = haar_variance(x, pivot);
    std::vector<long double> prefix(n + 1, 0.0L);
    for (std::size_t t = 0; t < n; ++t) {
      prefix[t + 1] = prefix[t] + (static_cast<long double>(x[t]) - static_cast<long double>(pivot));
    }
    for (std::size_t j = 19; j < curve.scales(); ++j) {
      const std::size_t m = curve.half[j];
      long double sum = 0.0L;
      for (std::size_t t = 2 * m; t <= n; ++t) {
        const long double w = prefix[t] - 2.0L * prefix[t - m] + prefix[t - 2 * m];
        sum += w * w;
      }
      const long double scale = 4.0L * static_cast<long double>(m) * static_cast<long double>(m);
      const double expected = static_cast<double>(sum / scale / static_cast<long double>(n - 2 * m + 1));
      EXPECT_NEAR(curve.variance[j], expected, 1e-11 * expected) << "n=" << n << " m=" << m;
    }
  }
}

TEST(HaarVariance, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  const std::vector<double> x(3000000, 1.0);
  EXPECT_EQ(haar_variance(x, 1.0, {.stop = source.get_token(), .progress = {}}).scales(), 0U);
}

TEST(HaarVariance, HasEveryScaleThatFits) {
  for (const std::size_t n : {2U, 3U, 4U, 1023U, 1024U, 1025U}) {
    const HaarVariance curve = variances(white(n, n));
    EXPECT_EQ(curve.scales(), static_cast<std::size_t>(std::floor(std::log2(n)))) << n;
    EXPECT_EQ(curve.coefficients(curve.scales() - 1), n - 2 * curve.half.back() + 1);
  }
  EXPECT_EQ(haar_variance(std::vector<double>{1.0}, 0.0).scales(), 0U);
}

TEST(HaarVariance, BiasOfAMillionSigmaCostsNoDigits) {
  // The bias itself rounds each sample to 2^-33 = 1.2e-10 sigma; against the same rounded samples without it, exactly
  // representable after subtraction, nothing further may be lost: 1e-12 is a few roundings of the sums.
  constexpr double kBias = 1048576.0;
  const std::vector<double> biased = white(100000, 3, kBias);
  std::vector<double> clean = biased;
  for (double& value : clean) {
    value -= kBias;
  }
  const HaarVariance a = variances(biased);
  const HaarVariance b = variances(clean);
  for (std::size_t j = 0; j < a.scales(); ++j) {
    EXPECT_NEAR(a.variance[j], b.variance[j], 1e-12 * b.variance[j]) << j;
  }
}

TEST(AllanVariance, AnyAveragingTimeEqualsItsDefinitionAndTwiceTheWaveletVariance) {
  const std::vector<double> x = white(9000, 21);
  const double pivot = summarise(x)->mean;
  const std::vector<std::size_t> m{1, 2, 3, 7, 100, 1000, 4096, 4500};
  const std::vector<double> variances_at = allan_variance(x, pivot, m);
  for (std::size_t k = 0; k < m.size(); ++k) {
    const double expected = 2.0 * by_definition(x, m[k]);
    EXPECT_NEAR(variances_at[k], expected, 1e-12 * expected) << m[k];
  }
  const HaarVariance curve = variances(x);
  const std::vector<double> octaves = allan_variance(x, pivot, curve.half);
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    EXPECT_NEAR(octaves[j], 2.0 * curve.variance[j], 1e-12 * octaves[j]);
  }
}

TEST(AllanVariance, LogSpacedTimesRiseFromOneToHalfTheRecord) {
  const auto m = log_spaced_half_lengths(1000000, 200);
  EXPECT_EQ(m.front(), 1U);
  EXPECT_EQ(m.back(), 500000U);
  EXPECT_TRUE(std::adjacent_find(m.begin(), m.end(), std::greater_equal<>()) == m.end());
  EXPECT_TRUE(log_spaced_half_lengths(1, 10).empty());
  EXPECT_EQ(log_spaced_half_lengths(2, 10), std::vector<std::size_t>{1});
}

TEST(HaarVariance, RampGivesItsClosedForm) {
  // x = w t: every coefficient is w m/2.
  std::vector<double> x(10000);
  for (std::size_t t = 0; t < x.size(); ++t) {
    x[t] = 5.0 + 0.25 * static_cast<double>(t);
  }
  const HaarVariance curve = variances(x);
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    const double expected = std::pow(0.25 * static_cast<double>(curve.half[j]) / 2.0, 2.0);
    EXPECT_NEAR(curve.variance[j], expected, 1e-12 * expected);
  }
}

TEST(Samples, NamesTheFirstBadRow) {
  std::vector<double> x = white(5000, 1);
  x[4321] = std::nan("");
  const auto nan = summarise(x);
  ASSERT_FALSE(nan.has_value());
  EXPECT_EQ(nan.error().code, ErrorCode::NonFinite);
  EXPECT_EQ(nan.error().fields.at(0), (ErrorField{"row", "4322"}));
  x[4321] = 0.0;
  x[17] = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(summarise(x).error().fields.at(0), (ErrorField{"row", "18"}));
  x[17] = 1e300;
  EXPECT_EQ(summarise(x).error().code, ErrorCode::OutOfRange);
}

TEST(Samples, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  const RunControl stopped{.stop = source.get_token(), .progress = {}};
  const std::vector<double> x = white(5000, 1);
  EXPECT_EQ(summarise(x, stopped).error().code, ErrorCode::Cancelled);
  EXPECT_EQ(prefix_sums(x, 0.0, stopped), nullptr);
  std::vector<double> peaked = x;
  peaked[17] = 1000.0;
  EXPECT_GT(difference_excess_kurtosis(peaked), 100.0);
  EXPECT_EQ(difference_excess_kurtosis(peaked, stopped), 0.0);
  const HaarVariance curve = variances(x);
  HaarCovariance plan(curve.half, x.size(), 1.0);
  const VarianceIntervals intervals = variance_intervals(curve, plan);
  EXPECT_TRUE(robust_variance(x, 0.0, curve, intervals, plan, {}, stopped).variance.empty());
}

TEST(Samples, MeanKeepsItsDigitsUnderABias) {
  std::vector<double> x(1 << 20, 0x1p40);
  for (std::size_t i = 0; i < x.size(); i += 2) {
    x[i] += 1.0;
  }
  EXPECT_EQ(summarise(x)->mean, 0x1p40 + 0.5);
}

}  // namespace
}  // namespace driftlab
