/// From which statistic a break of a clock is named, and from which it is not ruled out: the first is not reached where
/// the clock does not break, the second seldom, and often where it breaks by what an oracle sees at twelve standard
/// errors.
#include "core/investigate/consistency/reference_clock.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace driftlab::hidden {
namespace {

using namespace investigate;

/// Of studies of three recordings, made of consecutive seeds: those in which a break is found whose statistic is at
/// `least`, or that surpasses a clock that is off.
int reaching(const std::string& cause, std::uint64_t first, int studies, double least = kClockMayBreak) {
  int count = 0;
  for (int i = 0; i < studies; ++i) {
    Case hidden = make_case(cause, 12.0, 1000 * (first + static_cast<std::uint64_t>(i)) + 12);
    hidden.world.scenario = Scenario::Profile;
    const SimulatedStudy simulated = simulate_study(hidden.world, {hidden.effect});
    bool any = false;
    for (std::size_t r = 0; r < simulated.study.recordings.size(); ++r) {
      any = any || find_clock_fault(simulated.study, r, least).has_value();
    }
    count += any ? 1 : 0;
  }
  return count;
}

TEST(ClockMayBreak, IsSeldomSaidOfAClockThatDriftsAllTheTime) {
  EXPECT_LE(reaching("reference_clock_drift", 101, 200), 8);  // 2 % and three standard errors
}

TEST(ClockBreaks, IsSaidOfNoClockThatDoesNot) {
  EXPECT_EQ(reaching("reference_clock_drift", 301, 100, kClockBreaks), 0);
  EXPECT_EQ(reaching("scale_factor_nonlinearity", 301, 50, kClockBreaks), 0);
  EXPECT_EQ(reaching("reference_time_offset", 301, 50, kClockBreaks), 0);
}

/// 35 and 36 of forty, less three standard errors; none of these seeds was looked at when kBreakSurpasses was chosen.
TEST(ClockBreaks, IsSaidOfMostClocksThatDo) {
  EXPECT_GE(reaching("clock_jump", 501, 40, kClockBreaks), 29);
  EXPECT_GE(reaching("sampling_rate_change", 501, 40, kClockBreaks), 30);
}

TEST(ClockMayBreak, IsSaidOfMostClocksThatBreak) {
  EXPECT_GE(reaching("clock_jump", 1, 10), 5);
  EXPECT_GE(reaching("sampling_rate_change", 1, 10), 5);
}

}  // namespace
}  // namespace driftlab::hidden
