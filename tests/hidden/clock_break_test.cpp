/// From which statistic a break of a clock is not ruled out: seldom reached where the clock only drifts, often where it
/// breaks by what an oracle sees at twelve standard errors.
#include "core/investigate/consistency/reference_clock.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace driftlab::hidden {
namespace {

using namespace investigate;

/// Of studies of three recordings, made of consecutive seeds: those in which a break is not ruled out.
int not_ruled_out(const std::string& cause, std::uint64_t first, int studies) {
  int count = 0;
  for (int i = 0; i < studies; ++i) {
    Case hidden = make_case(cause, 12.0, 1000 * (first + static_cast<std::uint64_t>(i)) + 12);
    hidden.world.scenario = Scenario::Profile;
    const SimulatedStudy simulated = simulate_study(hidden.world, {hidden.effect});
    bool any = false;
    for (std::size_t r = 0; r < simulated.study.recordings.size(); ++r) {
      any = any || find_clock_fault(simulated.study, r, kClockMayBreak).has_value();
    }
    count += any ? 1 : 0;
  }
  return count;
}

TEST(ClockMayBreak, IsSeldomSaidOfAClockThatDriftsAllTheTime) {
  EXPECT_LE(not_ruled_out("reference_clock_drift", 101, 200), 8);  // 2 % and three standard errors
}

TEST(ClockMayBreak, IsSaidOfMostClocksThatBreak) {
  EXPECT_GE(not_ruled_out("clock_jump", 1, 10), 5);
  EXPECT_GE(not_ruled_out("sampling_rate_change", 1, 10), 5);
}

}  // namespace
}  // namespace driftlab::hidden
