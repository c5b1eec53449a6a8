/// Stamps of samples of which some are lost, are late, are rounded or come in bursts: which places they are given.
#include "core/signal/spacing.hpp"

#include "core/signal/recording.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <random>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

struct Lost {
  std::vector<double> stamps;
  std::vector<Gap> gaps;
};

/// Samples at `dt` of which `share` are lost, in gaps of `burst` on average; stamps err by `jitter` intervals.
Lost lose(double share, std::size_t count, double dt, double jitter = 0.0, double burst = 1.0, unsigned seed = 3) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, jitter * dt);
  const double start = share / burst / std::max(1e-9, 1.0 - share);  // of a gap, a sample
  Lost lost;
  std::size_t missing = 0;
  bool away = false;
  for (std::size_t i = 0; i < count; ++i) {
    const double draw = uniform(random);
    away = burst > 1.0 ? (away ? draw > 1.0 / burst : draw < start) : draw < share;
    if (away) {
      ++missing;
      continue;
    }
    if (missing > 0 && !lost.stamps.empty()) {
      lost.gaps.push_back({lost.stamps.size(), missing});
    }
    missing = 0;
    lost.stamps.push_back(dt * static_cast<double>(i) + (jitter > 0.0 ? normal(random) : 0.0));
  }
  return lost;
}

std::size_t total(const std::vector<Gap>& gaps) {
  return std::accumulate(gaps.begin(), gaps.end(), std::size_t{0},
                         [](std::size_t sum, const Gap& gap) { return sum + gap.missing; });
}

TEST(Spacing, PlacesSamplesHoweverManyAreLost) {
  // Above 2 % lost, stamps were read as bursts, and time was stretched by what was lost.
  for (const double share : {0.02, 0.05, 0.2, 0.5, 0.6}) {
    for (const double burst : {1.0, 10.0}) {
      const Lost lost = lose(share, 60000, 0.01, 0.0, burst);
      const Spacing found = find_spacing(lost.stamps, {}, 0.0);
      EXPECT_FALSE(found.bursts) << share;
      EXPECT_EQ(found.gaps, lost.gaps) << share << " in gaps of " << burst;
      EXPECT_NEAR(found.interval_s, 0.01, 1e-12);
      EXPECT_LT(found.jitter_s, 1e-9);
    }
  }
}

// A logger that kept every second sample of 100 Hz, and few of the others, was refused with --rate-hz 100: "the time
// column says 52.5 Hz".
TEST(Spacing, BelievesAStatedRateThatTheStampsAreMultiplesOf) {
  const Lost half = lose(0.0, 60000, 0.01);
  std::mt19937_64 random(5);
  std::vector<double> kept;
  for (std::size_t i = 0; i < half.stamps.size(); ++i) {
    if (i % 2 == 0 || random() % 20 == 0) {
      kept.push_back(half.stamps[i]);
    }
  }
  const Spacing found = find_spacing(kept, {}, 0.01);
  EXPECT_NEAR(found.interval_s, 0.01, 1e-12);
  EXPECT_EQ(total(found.gaps) + kept.size(), static_cast<std::size_t>(std::llround(kept.back() / 0.01)) + 1);
}

TEST(Spacing, DoesNotBelieveARateThatIsStatedTooHigh) {
  const auto interval = [](const std::vector<double>& stamps, double stated) {
    return find_spacing(stamps, {}, stated).interval_s;
  };
  for (const double share : {0.0, 0.1, 0.5}) {  // all steps are multiples of two, four, five stated intervals
    for (const double stated : {0.005, 0.0025, 0.002}) {
      EXPECT_NEAR(interval(lose(share, 60000, 0.01).stamps, stated), 0.01, 1e-9) << share << ", " << stated;
    }
  }
  // Stamps in whole milliseconds of a sensor of 104 Hz are multiples of a millisecond, 9 and 10 of them, that make up
  // for each other.
  std::vector<double> rounded;
  for (int i = 0; i < 30000; ++i) {
    rounded.push_back(1e-3 * std::round(1e3 * i / 104.0));
  }
  EXPECT_GT(interval(rounded, 1e-3), 0.009);
}

TEST(Spacing, PlacesSamplesWhoseStampsJitter) {
  for (const double share : {0.02, 0.05, 0.2, 0.5}) {
    for (const double jitter : {0.05, 0.1}) {
      const Lost lost = lose(share, 60000, 0.01, jitter);
      const Spacing found = find_spacing(lost.stamps, {}, 0.0);
      EXPECT_FALSE(found.bursts) << share << " " << jitter;
      // Two stamps that err by half an interval towards each other hide one place; both ends of the record may, too.
      EXPECT_NEAR(static_cast<double>(total(found.gaps)), static_cast<double>(total(lost.gaps)), 1.0)
          << share << " " << jitter;
      EXPECT_NEAR(found.interval_s, 0.01, 0.01 * 2.0 / 60000.0);
    }
  }
}

TEST(Spacing, PlacesSamplesWhoseStampsAreRounded) {
  // 2.5 ms in whole milliseconds, 10 ms in single precision, 1.25 ms in microseconds.
  Lost coarse = lose(0.2, 60000, 0.0025);
  for (double& stamp : coarse.stamps) {
    stamp = 1e-3 * std::round(stamp * 1e3);
  }
  Lost single = lose(0.2, 60000, 0.01);
  for (double& stamp : single.stamps) {
    stamp = static_cast<double>(static_cast<float>(stamp));
  }
  Lost fine = lose(0.2, 60000, 0.00125);
  for (double& stamp : fine.stamps) {
    stamp = 1e-6 * std::round(stamp * 1e6);
  }
  EXPECT_EQ(find_spacing(coarse.stamps, {}, 0.0).gaps, coarse.gaps);
  EXPECT_EQ(find_spacing(single.stamps, {}, 0.0).gaps, single.gaps);
  EXPECT_EQ(find_spacing(fine.stamps, {}, 0.0).gaps, fine.gaps);
}

TEST(Spacing, FollowsAClockThatRunsFastThenSlow) {
  // 1e-4 fast, then as slow: half an hour away from the mean rate by nine samples.
  Lost lost = lose(0.2, 180000, 0.01);
  for (double& stamp : lost.stamps) {
    stamp += stamp < 900.0 ? 1e-4 * stamp : 0.09 - 1e-4 * (stamp - 900.0);
  }
  EXPECT_EQ(find_spacing(lost.stamps, {}, 0.0).gaps, lost.gaps);
}

TEST(Spacing, KeepsALongGapBesideLostSamples) {
  Lost lost = lose(0.2, 60000, 0.01);
  const std::size_t row = lost.stamps.size() / 2;
  for (std::size_t i = row; i < lost.stamps.size(); ++i) {
    lost.stamps[i] += 3600.0;
  }
  const Spacing found = find_spacing(lost.stamps, {}, 0.0);
  EXPECT_FALSE(found.bursts);
  EXPECT_EQ(total(found.gaps), total(lost.gaps) + 360000U);
}

TEST(Spacing, TellsARoundedClockFromLostSamples) {
  // 1.25 ms in whole milliseconds: steps of 1, 1, 1 and 2 ms, though nothing is lost.
  std::vector<double> stamps(8000);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    stamps[i] = 1e-3 * std::floor(1.25 * static_cast<double>(i));
  }
  const Spacing even = find_spacing(stamps, {}, 0.0);
  EXPECT_TRUE(even.bursts);
  EXPECT_EQ(total(even.gaps), 0U);
  EXPECT_NEAR(even.interval_s, 1.25e-3, 1e-6);
  // Of a sensor that is said to run at 1 kHz every fifth sample is lost.
  const Spacing stated = find_spacing(stamps, {}, 1e-3);
  EXPECT_FALSE(stated.bursts);
  EXPECT_EQ(total(stated.gaps), 1999U);
}

TEST(Spacing, TellsPacketsStampedOnArrivalFromLostSamples) {
  // Packets of three samples arrive every 30 ms with a delay of their own, and are stamped 0.3 ms apart.
  std::mt19937_64 random(5);
  std::exponential_distribution<double> delay(1.0 / 0.004);
  std::vector<double> stamps;
  double arrival = 0.0;
  for (std::size_t packet = 0; packet < 4000; ++packet) {
    arrival = std::max(arrival + 0.001, 0.03 * static_cast<double>(packet) + delay(random));
    for (int k = 0; k < 3; ++k) {
      stamps.push_back(arrival + 0.0003 * k);
    }
  }
  const Spacing found = find_spacing(stamps, {}, 0.0);
  EXPECT_TRUE(found.bursts);
  EXPECT_EQ(total(found.gaps), 0U);
}

TEST(Spacing, FindsNoGridUnderStampsThatWander) {
  // A busy host reads 50 samples a second, none lost; what it is late adds up, and is made up for in a second or so.
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, 0.0035);
  std::vector<double> stamps;
  double late = 0.0;
  for (std::size_t i = 0; i < 10000; ++i) {
    late = 0.98 * late + normal(random);
    stamps.push_back(std::max(0.02 * static_cast<double>(i) + late, stamps.empty() ? 0.0 : stamps.back() + 0.001));
  }
  EXPECT_LT(total(find_spacing(stamps, {}, 0.0).gaps), 50U);  // half a percent, against 5 % on a grid
}

TEST(PlanWindow, KeepsTheRateOfARecordingThatLostAFifthAndOfOneThatLostHalf) {
  for (const double share : {0.2, 0.5}) {
    const Lost lost = lose(share, 60000, 0.01);
    RecordingSpec spec;
    const auto window = plan_window(spec, lost.stamps.size(), lost.stamps, *parse_unit("s"));
    ASSERT_TRUE(window) << window.error().message;
    EXPECT_NEAR(window->time.dt_s, 0.01, 1e-9);
    EXPECT_EQ(window->count, lost.stamps.size());
    EXPECT_EQ(window->quality.missing, total(lost.gaps));
    EXPECT_THAT(window->quality.notes, Contains(HasSubstr("samples are missing in the gaps")));
  }
}

}  // namespace
}  // namespace driftlab
