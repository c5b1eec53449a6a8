// Equal neighbours of rounded noise, with samples held over and without.
#include "core/campaign/regression/held_share.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::regression {
namespace {

constexpr std::size_t kSamples = 30000;

/// What a run sees of noise of `steps` steps about `place`: white, or a first-order filter's whose samples correlate by
/// 0.7. `held` of the samples are given out twice.
HeldShare seen(Random& random, double steps, double place, bool filtered, double held) {
  double state = 0.0;
  double before = 0.0;
  double square = 0.0;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double white = steps * random.normal();
    state = filtered ? 0.7 * state + std::sqrt(1.0 - 0.49) * white : white;
    const double value = i > 0 && random.uniform() < held ? before : std::round(state + place);
    equal += i > 0 && value == before ? 1 : 0;
    square += i > 0 ? (value - before) * (value - before) : 0.0;
    before = value;
  }
  return held_share(static_cast<double>(equal) / kSamples, kSamples, square / (kSamples - 1), 1.0);
}

TEST(HeldShare, RoundingAloneIsNoHeldSample) {
  Random random(71, 0);
  for (const double steps : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 5.0, 20.0}) {
    for (const bool filtered : {false, true}) {
      for (int run = 0; run < 10; ++run) {
        const double place = random.uniform() - 0.5;
        EXPECT_EQ(seen(random, steps, place, filtered, 0.0).low, 0.0) << steps << " steps about " << place;
      }
    }
  }
}

TEST(HeldShare, BoundsHoldTheTruth) {
  Random random(72, 0);
  for (const double held : {0.0, 0.05, 0.2}) {
    for (const double steps : {0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 20.0}) {
      for (const bool filtered : {false, true}) {
        const HeldShare share = seen(random, steps, random.uniform() - 0.5, filtered, held);
        EXPECT_LE(share.low, held) << steps;
        EXPECT_GE(share.high, held) << steps;
      }
    }
  }
}

TEST(HeldShare, SeesAFifthHeldOverWhereTheNoiseIsAStepOrMore) {
  Random random(73, 0);
  for (const double steps : {1.0, 2.0, 5.0, 20.0}) {
    EXPECT_GT(seen(random, steps, 0.3, false, 0.2).low, seen(random, steps, 0.1, false, 0.0).high) << steps;
  }
}

TEST(HeldShare, IsTheShareItselfWithoutALattice) {
  const HeldShare share = held_share(0.02, kSamples, 1.0, 0.0);
  EXPECT_EQ(share.low, 0.02);
  EXPECT_EQ(share.high, 0.02);
  EXPECT_EQ(held_share(0.02, kSamples, 1.0, 1e-6).low, 0.02) << "the last digit of a float";
}

}  // namespace
}  // namespace driftlab::regression
