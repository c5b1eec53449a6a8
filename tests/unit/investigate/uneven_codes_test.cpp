/// A converter whose codes are not of one width, against coarse outputs whose codes are.
#include "core/investigate/report/uneven_codes.hpp"

#include "core/process/random.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kStep = 0.05;
constexpr std::size_t kSamples = 20'000;

/// Two recordings of codes; of every `period` codes the first is wider by a share of the step, the second narrower.
struct Converter {
  Converter(double deviation, double share, long long period, std::uint64_t seed, double nu = 0.0)
      : noise({std::vector<double>(kSamples), std::vector<double>(kSamples)}) {
    for (std::size_t r = 0; r < 2; ++r) {
      Random random(seed, r);
      std::vector<double>& rows = columns.emplace_back();
      for (std::size_t i = 0; i < kSamples; ++i) {
        const double at = (nu > 0.0 ? random.student(nu) : random.normal()) * deviation +
                          3.0 * std::sin(0.001 * static_cast<double>(i));
        const double code = std::floor(at);
        const bool wide = std::fmod(std::fmod(code, static_cast<double>(period)) + static_cast<double>(period),
                                    static_cast<double>(period)) == 1.0;
        rows.push_back(kStep * (wide && at - code < share ? code - 1.0 : code));
      }
      Channel& channel = noise.channels[r];
      channel.unit = parse_unit("rad/s").value();
      channel.rows = rows;
      channel.measured = Series::view(rows);
      channel.valid = Presence(std::vector<unsigned char>(kSamples, 1));
    }
  }
  [[nodiscard]] Remainder look() const { return uneven_codes(noise.group, noise.data); }

  std::deque<std::vector<double>> columns;
  NoiseAtFullRate noise;
};

TEST(UnevenCodes, AreFoundWithTheirPeriod) {
  const Remainder two = Converter(3.0, 0.05, 2, 1).look();
  EXPECT_GT(two.observed, 25.0);  // z = 0.05 sqrt(40,000) = 10: half its square is 50
  EXPECT_NE(two.sentence.find("after every 2 of them"), std::string::npos) << two.sentence;
  const Remainder eight = Converter(8.0, 0.3, 8, 1).look();
  EXPECT_GT(eight.observed, 25.0);
}

TEST(UnevenCodes, AreNoneWhereCodesAreAlike) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const double deviation : {2.0, 5.0, 20.0}) {
      const Remainder none = Converter(deviation, 0.0, 2, seed).look();
      EXPECT_GT(none.places * std::exp(-none.observed), 1e-4) << deviation << ", seed " << seed;
    }
  }
}

TEST(UnevenCodes, AreNotAskedForWhereTheNoiseDoesNotSpreadOverThem) {
  EXPECT_EQ(Converter(0.7, 0.3, 2, 1).look().observed, 0.0);
  EXPECT_EQ(Converter(2.0, 0.0, 2, 1, 3.0).look().observed, 0.0) << "whose distribution has a peak";
  EXPECT_EQ(Converter(60.0, 0.0, 2, 1).look().observed, 0.0) << "the last digit that is written";
}

}  // namespace
}  // namespace driftlab::investigate
