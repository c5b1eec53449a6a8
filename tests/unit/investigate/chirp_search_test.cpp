#include "core/investigate/causes/chirp_search.hpp"

#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

constexpr double kTurnOf = 2.0 * std::numbers::pi;
constexpr double kDt = 0.02;
constexpr std::size_t kCount = 30000;
constexpr double kSeconds = kCount * kDt;

struct Run {
  double f0_hz = 0.0;
  double f1_hz = 0.0;
};

/// White recordings of unit variance that share a chirp, which an oracle sees at z deviations in all of them together.
std::vector<std::vector<double>> chirped(std::size_t recordings, double z, const Run& run, std::uint64_t seed) {
  const double amplitude = z * std::sqrt(2.0 / static_cast<double>(recordings * kCount));
  std::vector<std::vector<double>> all;
  for (std::size_t r = 0; r < recordings; ++r) {
    std::vector<double>& values = all.emplace_back(white(kCount, seed, r));
    for (std::size_t i = 0; i < kCount; ++i) {
      const double t = static_cast<double>(i) * kDt;
      const double turns = run.f0_hz * t + 0.5 * (run.f1_hz - run.f0_hz) * t * t / kSeconds;
      values[i] += amplitude * std::sin(kTurnOf * turns + static_cast<double>(r));
    }
  }
  return all;
}

/// How many of twenty chirps of different runs are followed to both ends.
int followed_of_twenty(std::size_t recordings, double z) {
  int count = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto step = static_cast<double>(i);
    const Run run{2.0 + 0.9 * step, 22.3 - 1.05 * step};
    const NoiseAtFullRate noise(chirped(recordings, z, run, 700 + i), kDt);
    std::vector<std::size_t> all;
    for (std::size_t r = 0; r < recordings; ++r) {
      all.push_back(r);
    }
    const auto found = chirps_of(noise.data, {all});
    count += found[0] && std::fabs(found[0]->sweep.f_hz - run.f0_hz) < 1.0 / kSeconds &&
                     std::fabs(found[0]->sweep.at(kSeconds) - run.f1_hz) < 1.0 / kSeconds
                 ? 1
                 : 0;
  }
  return count;
}

TEST(ChirpSearch, FollowsAChirpOfTwelveDeviationsInOneRecording) { EXPECT_GE(followed_of_twenty(1, 12.0), 18); }

TEST(ChirpSearch, FollowsAChirpOfTwelveDeviationsThatThreeShare) { EXPECT_GE(followed_of_twenty(3, 12.0), 18); }

TEST(ChirpSearch, FollowsAChirpOfTwelveDeviationsThatFiveShare) { EXPECT_GE(followed_of_twenty(5, 12.0), 16); }

TEST(ChirpSearch, FollowsMostOfTheChirpsOfTwelveDeviationsThatSevenShare) {
  EXPECT_GE(followed_of_twenty(7, 12.0), 10);
}

TEST(ChirpSearch, FollowsAStrongChirp) { EXPECT_EQ(followed_of_twenty(3, 30.0), 20); }

TEST(ChirpSearch, WhereTheNoiseIsWhiteTheBestChirpIsOneOfChance) {
  // A chance of e^-(x/2) at each of (f_max T)^2/2 places, of which the search meets the largest or none: what is beyond
  // that by 8 in x would be there in 2 % of 40.
  const double places = 0.5 * std::pow(0.5 / kDt * kSeconds, 2.0);
  int beyond = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const NoiseAtFullRate noise({white(kCount, 800 + i)}, kDt);
    const auto found = chirps_of(noise.data, {{0}});
    beyond += found[0] && found[0]->x > 2.0 * std::log(places) + 8.0 ? 1 : 0;
  }
  EXPECT_LE(beyond, 3);
}

TEST(ChirpSearch, RecordingsOfAFewPiecesHaveNone) {
  const NoiseAtFullRate noise({white(100, 1)}, kDt);
  EXPECT_FALSE(chirps_of(noise.data, {{0}})[0]);
}

}  // namespace
}  // namespace driftlab::investigate
