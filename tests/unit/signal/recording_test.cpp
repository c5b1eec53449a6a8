#include "core/signal/recording.hpp"

#include "tests/unit/signal/failure.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RecordingSpec at_rate(double rate_hz, Trim trim = {}) {
  RecordingSpec spec;
  spec.rate_hz = rate_hz;
  spec.trim = trim;
  return spec;
}

std::vector<double> stamps(std::size_t count, double step) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<double>(i) * step;
  }
  return values;
}

Result<Window> plan(const RecordingSpec& spec, const std::vector<double>& time, const char* symbol = "s") {
  return plan_window(spec, time.size(), time, *parse_unit(symbol));
}

TEST(PlanWindow, IsUniformWithoutATimeColumn) {
  const auto window = plan_window(at_rate(50.0, {30.0, 20.0}), 5000, {}, Unit{});
  ASSERT_TRUE(window);
  EXPECT_EQ(window->time.dt_s, 1.0 / 50.0);
  EXPECT_EQ(window->first, 1500U);
  EXPECT_EQ(window->count, 5000U - 1500U - 1000U);
  EXPECT_EQ(window->quality.samples, 5000U);
  EXPECT_EQ(window->quality.analysed, 2500U);
  EXPECT_EQ(window->quality.measured_rate_hz, 0.0);
  EXPECT_THAT(window->quality.notes, IsEmpty());
}

TEST(PlanWindow, TrimsTheSameRowsWithAndWithoutATimeColumn) {
  for (const Trim trim : {Trim{0.0, 0.0}, Trim{30.0, 30.0}, Trim{0.015, 0.0}, Trim{0.1, 0.3}, Trim{12.34, 7.001}}) {
    const auto uniform = plan_window(at_rate(100.0, trim), 10000, {}, Unit{});
    const auto stamped = plan(at_rate(100.0, trim), stamps(10000, 0.01));
    ASSERT_TRUE(uniform && stamped);
    EXPECT_EQ(uniform->first, stamped->first) << trim.start_s;
    EXPECT_EQ(uniform->count, stamped->count) << trim.end_s;
  }
}

TEST(PlanWindow, NeedsARateOrATimeColumn) {
  EXPECT_EQ(failure(plan_window({}, 100, {}, Unit{})), "inconsistent_sampling parameter=rate_hz");
}

TEST(PlanWindow, NamesTheSettingThatIsWrong) {
  EXPECT_EQ(failure(plan_window(at_rate(0.0), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(-1.0), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(std::nan("")), 100, {}, Unit{})), "invalid_argument parameter=rate_hz");
  EXPECT_EQ(failure(plan_window(at_rate(1.0, {-1.0, 0.0}), 100, {}, Unit{})),
            "invalid_argument parameter=trim.start_s");
  EXPECT_EQ(failure(plan_window(at_rate(1.0, {0.0, INFINITY}), 100, {}, Unit{})),
            "invalid_argument parameter=trim.end_s");
}

TEST(PlanWindow, RefusesWhatTheTrimsLeaveNothingOf) {
  EXPECT_EQ(failure(plan_window(at_rate(10.0, {9.0, 1.0}), 100, {}, Unit{})), "too_few_samples parameter=trim.start_s");
  EXPECT_EQ(failure(plan_window(at_rate(10.0, {1.0, 1e300}), 100, {}, Unit{})), "too_few_samples parameter=trim.end_s");
  EXPECT_EQ(failure(plan(at_rate(10.0, {60.0, 0.0}), stamps(100, 0.1))), "too_few_samples parameter=trim.start_s");
}

TEST(PlanWindow, RefusesOneSample) {
  EXPECT_EQ(failure(plan_window(at_rate(10.0), 1, {}, Unit{})), "too_few_samples");
  EXPECT_EQ(failure(plan(at_rate(10.0), {1.0})), "too_few_samples");
}

TEST(PlanWindow, ReadsTheRateFromTheTimeColumn) {
  const auto window = plan({}, stamps(1001, 20.0), "ms");
  ASSERT_TRUE(window);
  EXPECT_DOUBLE_EQ(window->time.dt_s, 0.02);
  EXPECT_DOUBLE_EQ(window->quality.measured_rate_hz, 50.0);
  EXPECT_EQ(window->count, 1001U);
}

TEST(PlanWindow, TakesTheStatedRateWhereTheStampsConfirmIt) {
  // Stamps as decimal text: 0.02 i rounds, and the mean step differs from 1/50 in the last bits.
  EXPECT_EQ(plan(at_rate(50.0), stamps(1001, 0.02))->time.dt_s, 1.0 / 50.0);
}

TEST(PlanWindow, LetsTheTimeColumnRuleWithinOnePercent) {
  const auto window = plan(at_rate(50.0), stamps(1001, 0.0201));
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_NEAR(window->time.dt_s, 0.0201, 1e-12);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("49.7512 Hz where 50 Hz is stated")));
}

TEST(PlanWindow, NamesBothRatesWhenTheyContradict) {
  const auto window = plan(at_rate(50.0), stamps(1001, 0.025));
  EXPECT_EQ(failure(window), "inconsistent_sampling parameter=rate_hz stated_hz=50 measured_hz=40");
  EXPECT_THAT(window.error().message, HasSubstr("50 Hz"));
  EXPECT_THAT(window.error().message, HasSubstr("40 Hz"));
}

TEST(PlanWindow, ReadsAnUnstatedTimeUnitAsSecondsOnlyIfTheRateAgrees) {
  const auto agrees = plan(at_rate(50.0), stamps(100, 0.02), "1");
  ASSERT_TRUE(agrees);
  EXPECT_THAT(agrees->quality.notes, Contains(HasSubstr("no unit")));
  const auto in_ms = plan(at_rate(50.0), stamps(100, 20.0), "1");
  ASSERT_FALSE(in_ms);
  EXPECT_EQ(in_ms.error().code, ErrorCode::InconsistentSampling);
  EXPECT_THAT(in_ms.error().message, HasSubstr("In ms it would agree"));
  const auto nothing = plan({}, stamps(100, 0.02), "1");
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::InconsistentSampling);
  EXPECT_THAT(nothing.error().message, HasSubstr("no unit"));
}

TEST(PlanWindow, NamesTheSampleAtWhichTimeStepsBackOrIsNoNumber) {
  std::vector<double> time = stamps(100, 0.01);
  time[40] = 0.2;
  EXPECT_EQ(failure(plan({}, time)), "non_monotonic_time row=41");
  time[40] = std::nan("");
  EXPECT_EQ(failure(plan({}, time)), "non_finite row=41");
  EXPECT_EQ(failure(plan({}, std::vector<double>(10, 3.0))), "inconsistent_sampling");
}

TEST(PlanWindow, CountsRepeatedStampsAndKeepsThem) {
  std::vector<double> time = stamps(1000, 0.01);
  time[500] = time[499];  // the step behind it is twice as long, but nothing is missing
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->count, 1000U);
  EXPECT_EQ(window->quality.gaps, 0U);
  EXPECT_EQ(window->quality.repeated_stamps, 1U);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("1 time stamp repeats the one before.")));
}

TEST(PlanWindow, SplitsAtGapsOfMoreThanAFifth) {
  // 100 samples, a gap of 5 s, 300 samples, a gap of 2 s, 200 samples.
  std::vector<double> time;
  double now = 10.0;
  for (int i = 0; i < 600; ++i) {
    now += i == 100 ? 5.0 : i == 400 ? 2.0 : 0.01;
    time.push_back(now);
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 2U);
  EXPECT_NEAR(window->quality.longest_gap_s, 5.0, 1e-9);
  EXPECT_EQ(window->first, 100U);
  EXPECT_EQ(window->count, 300U);
  EXPECT_EQ(window->quality.samples, 600U);
  EXPECT_NEAR(window->time.dt_s, 0.01, 1e-12);
  EXPECT_NEAR(window->time.start_s, 10.01, 1e-12);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("300 of 600 samples are analysed, from sample 101")));
}

TEST(PlanWindow, AnalysesWhatLiesOnBothSidesOfAGap) {
  // 2000 samples, 0.5 s lost, 3000 samples, 2 s lost, 1000 samples.
  std::vector<double> time = stamps(6000, 0.01);
  for (std::size_t i = 2000; i < time.size(); ++i) {
    time[i] += i >= 5000 ? 2.5 : 0.5;
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->count, 6000U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{2000, 50}, Gap{5000, 200}));
  EXPECT_EQ(window->quality.missing, 250U);
  EXPECT_EQ(window->time.dt_s, 0.01);
  EXPECT_THAT(window->quality.notes, Contains(HasSubstr("250 samples are missing")));
}

TEST(PlanWindow, TakesALateStampThatIsMadeUpForAsNoGap) {
  // Stamps of a host: every hundredth is 8 ms late, the next ones on time again. One sample is really lost.
  std::vector<double> time = stamps(5001, 0.01);
  time.erase(time.begin() + 2320);
  for (std::size_t i = 50; i < time.size(); i += 100) {
    time[i] += 0.008;
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 51U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{2320, 1}));
  EXPECT_EQ(window->count, 5000U);
}

TEST(PlanWindow, CountsGapsThatLieCloseTogether) {
  // Of 4000 samples, at 1000, 1003 and 1010 one, two and three are lost.
  std::vector<double> time;
  for (std::size_t i = 0; i < 4000; ++i) {
    const bool lost = i == 1000 || (i >= 1004 && i < 1006) || (i >= 1013 && i < 1016);
    if (!lost) {
      time.push_back(0.01 * static_cast<double>(i));
    }
  }
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  std::size_t missing = 0;
  for (const Gap& gap : window->gaps) {
    missing += gap.missing;
    EXPECT_NEAR(static_cast<double>(gap.row), 1005.0, 5.0);
  }
  EXPECT_EQ(missing, 6U);
  EXPECT_EQ(window->time.dt_s, 0.01);
}

TEST(PlanWindow, UnderstandsFifosStampedAtOnce) {
  // Four samples share each stamp, every 40 ms; the eleventh FIFO is lost.
  std::vector<double> time(400);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t fifo = i / 4 + (i >= 40 ? 1 : 0);
    time[i] = 0.04 * static_cast<double>(fifo);
  }
  const auto window = plan({}, time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.repeated_stamps, 300U);
  EXPECT_EQ(window->quality.gaps, 1U);
  EXPECT_EQ(window->count, 400U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{40, 4}));
  EXPECT_NEAR(window->time.dt_s, 0.01, 1e-12);
}

TEST(PlanWindow, MeasuresTheRateOfStampsInWholeSeconds) {
  for (const double start : {0.0, 0.304, 0.995}) {
    std::vector<double> time = stamps(2000, 0.01);
    for (double& stamp : time) {
      stamp = std::floor(stamp + start + 1e-9);
    }
    const auto window = plan({}, time);
    ASSERT_TRUE(window) << window.error().message;
    // Nobody sees where within its second a sample was taken: one sample in some eighteen seconds.
    EXPECT_NEAR(window->time.rate_hz(), 100.0, 0.06) << start;
    EXPECT_NEAR(window->quality.measured_rate_hz, 100.0, 0.06) << start;
    EXPECT_THAT(window->gaps, IsEmpty()) << start;
  }
}

TEST(PlanWindow, SeesOneMissingSample) {
  std::vector<double> time = stamps(1000, 0.01);
  time.erase(time.begin() + 700);
  const auto window = plan(at_rate(100.0), time);
  ASSERT_TRUE(window) << window.error().message;
  EXPECT_EQ(window->quality.gaps, 1U);
  EXPECT_EQ(window->count, 999U);
  EXPECT_THAT(window->gaps, ElementsAre(Gap{700, 1}));
}

TEST(PlanWindow, MeasuresTheMeanOfCoarseStamps) {
  // 300 Hz stamped in whole milliseconds: steps of 3 and 4 ms, median 3; the mean is right.
  std::vector<double> time(3001);
  for (std::size_t i = 0; i < time.size(); ++i) {
    time[i] = std::floor(static_cast<double>(i) * 1000.0 / 300.0);
  }
  const auto window = plan({}, time, "ms");
  ASSERT_TRUE(window);
  EXPECT_EQ(window->quality.gaps, 0U);
  // 3000 steps end on a whole millisecond, at 10 s exactly.
  EXPECT_DOUBLE_EQ(window->time.dt_s, 10.0 / 3000.0);
}

TEST(Window, LastsAsLongAsItsSamplesAndThoseMissingBetweenThem) {
  Window window;
  window.time.dt_s = 0.02;
  window.count = 300;
  window.quality.missing = 50;
  EXPECT_DOUBLE_EQ(window.duration_s(), 7.0);
  EXPECT_DOUBLE_EQ(window.time.rate_hz(), 50.0);
}

TEST(Quality, SaysHowManySamplesOfAColumnAreFrozenAndNoneOfAColumnThatItDoesNotKnow) {
  Quality quality;
  quality.channels.resize(2);
  quality.channels[0].column = "gx";
  quality.channels[0].frozen = 7;
  quality.channels[1].column = "gz";
  EXPECT_EQ(frozen_samples(quality, "gx"), 7U);
  EXPECT_EQ(frozen_samples(quality, "gz"), 0U);
  EXPECT_EQ(frozen_samples(quality, "gy"), 0U);
  EXPECT_EQ(quality.of("gz"), &quality.channels[1]);
  EXPECT_EQ(quality.of("gy"), nullptr);
}

}  // namespace
}  // namespace driftlab
