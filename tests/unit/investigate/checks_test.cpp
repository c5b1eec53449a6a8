/// The battery of checks: degrees of freedom, and the correction for their number.
#include "core/investigate/report/checks.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/process/distributions.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

/// One channel of some recordings at 10 Hz, its innovations standard normal as under a right model.
struct World {
  std::vector<StudyRecording> recordings;
  std::vector<ChannelGroup> groups;
  std::vector<GroupOutcome> outcomes;

  World(std::size_t count, std::size_t samples) {
    recordings.resize(count);
    groups.resize(1);
    outcomes.resize(1);
    groups[0].column = "gz";
    outcomes[0].usable = true;
    FullRate data;
    data.dt_s = 0.1;
    for (std::size_t r = 0; r < count; ++r) {
      recordings[r].id = "run-" + std::to_string(r);
      recordings[r].channels.resize(1);
      recordings[r].channels[0].column = "gz";
      Random random(4, r);
      std::vector<double> e(samples);
      std::generate(e.begin(), e.end(), [&] { return random.normal(); });
      data.innovation.push_back(std::move(e));
      data.used.emplace_back(samples, 1);
      data.spectrum.emplace_back();
    }
    for (const StudyRecording& recording : recordings) {
      groups[0].members.push_back({&recording, recording.channels.data()});
    }
    data.group = groups.data();
    outcomes[0].before = data;
    outcomes[0].after = data;
  }

  /// Makes the innovations [from, to) of a recording louder, as they were before the search.
  void raise(std::size_t recording, std::size_t from, std::size_t to, double factor) {
    Series& innovation = outcomes[0].before.innovation[recording];
    std::vector<double> e = innovation.values();
    std::for_each(e.begin() + static_cast<std::ptrdiff_t>(from), e.begin() + static_cast<std::ptrdiff_t>(to),
                  [&](double& v) { v *= factor; });
    innovation = std::move(e);
  }

  [[nodiscard]] Report report(const std::vector<Evidence>& examined = {}) const {
    Report report;
    make_checks(groups, outcomes, {check_channel(groups[0], outcomes[0])}, examined, report);
    return report;
  }
};

const Check& check_called(const Report& report, const std::string& id) {
  const auto found =
      std::find_if(report.checks.begin(), report.checks.end(), [&](const Check& check) { return check.id == id; });
  EXPECT_NE(found, report.checks.end()) << id;
  return *found;
}

/// Causes seen in the noise, one for each score.
std::vector<Evidence> examined_with(const std::vector<double>& scores) {
  std::vector<Evidence> examined;
  for (const Cause& cause : cause_registry()) {
    if (cause.as<FileFact>() == nullptr && examined.size() < scores.size()) {
      Evidence evidence;
      evidence.cause = &cause;
      evidence.score = scores[examined.size()];
      examined.push_back(evidence);
    }
  }
  return examined;
}

/// A recording in use only in its first quarter has four segments to compare; the check compared its statistic with a
/// chi-square of fifteen degrees of freedom, as if all sixteen had been there, and never failed.
TEST(Checks, SegmentsWithoutSamplesAreNoDegreesOfFreedom) {
  World world(1, 8000);
  std::fill(world.outcomes[0].before.used[0].begin() + 2000, world.outcomes[0].before.used[0].end(), 0);
  const Report quarter = world.report();
  EXPECT_DOUBLE_EQ(check_called(quarter, "run-0/gz.variance_over_time").median, chi_squared_quantile(0.5, 3.0));
  // 500 samples each; three of variance 1 and one of 1.21: 0.5 * 500 * (3 * 0.05^2 + 0.15^2) is about 7.5, which is
  // little for fifteen degrees of freedom and 0.06 for three.
  world.raise(0, 1500, 2000, 1.3);
  EXPECT_LT(check_called(world.report(), "run-0/gz.variance_over_time").p, 0.01);
  const Report whole = World(1, 8000).report();
  EXPECT_DOUBLE_EQ(check_called(whole, "run-0/gz.variance_over_time").median, chi_squared_quantile(0.5, 15.0));
}

/// One segment in use has nothing to be compared with.
TEST(Checks, OneSegmentIsNotComparedWithItself) {
  World world(1, 16000);
  std::fill(world.outcomes[0].before.used[0].begin() + 1000, world.outcomes[0].before.used[0].end(), 0);
  const Report report = world.report();
  EXPECT_TRUE(std::none_of(report.checks.begin(), report.checks.end(),
                           [](const Check& check) { return check.id.ends_with("variance_over_time"); }));
}

/// Six seconds have six means of one second and five lags between them; the page said ten.
TEST(Checks, LagsThatDoNotExistAreNoDegreesOfFreedom) {
  World world(1, 600);
  world.outcomes[0].before.dt_s = 0.01;
  EXPECT_DOUBLE_EQ(check_called(world.report(), "run-0/gz.whiteness").median, chi_squared_quantile(0.5, 5.0));
}

/// The page said that p is adjusted over all checks of a study by Holm; in truth only the general ones were, and those
/// of causes by themselves, each with its own rule.
TEST(Checks, HolmRunsOverAllChecksOfTheStudyTogether) {
  World world(3, 4000);
  world.raise(1, 0, 250, 1.5);
  const Report report = world.report(examined_with({30.0, 12.0, 8.0, 1.0, -2.0}));
  std::vector<Check> sorted = report.checks;
  std::sort(sorted.begin(), sorted.end(), [](const Check& a, const Check& b) { return a.p < b.p; });
  double running = 0.0;
  std::size_t failed = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    running = std::max(running, std::min(1.0, sorted[i].p * static_cast<double>(sorted.size() - i)));
    EXPECT_DOUBLE_EQ(sorted[i].p_adjusted, running) << sorted[i].id;
    EXPECT_EQ(sorted[i].failed, running < 0.05) << sorted[i].id;
    failed += running < 0.05 ? 1 : 0;
  }
  EXPECT_EQ(report.failed_before, failed);
  EXPECT_GE(failed, 2U);
  // Five causes, and the level that the recordings keep.
  EXPECT_EQ(
      std::count_if(report.checks.begin(), report.checks.end(), [](const Check& c) { return c.recording.empty(); }), 6);
}

/// A page said "No check fails with the extended model" beside `checks_failed_after: 1`: what failed at 5 % was
/// counted, and what failed at 1 % was told.
TEST(Checks, EachThatFailsComesToRestSomewhere) {
  World world(3, 4000);
  world.raise(1, 0, 250, 1.5);
  std::vector<double> after = world.outcomes[0].after.innovation[2].values();
  after[100] = 12.0;  // kurtosis, just after the search
  world.outcomes[0].after.innovation[2] = after;
  Evidence found;
  found.cause = &cause_registry().front();
  found.members = {0};
  world.outcomes[0].found = {found};
  Report report = world.report(examined_with({30.0, 12.0, 8.0}));
  settle_ends(report);
  EXPECT_TRUE(check_called(report, "run-1/gz.variance_over_time").failed);
  EXPECT_EQ(check_called(report, "run-1/gz.variance_over_time").end, CheckEnd::Mended);
  std::size_t failed = 0;
  for (const Check& check : report.checks) {
    EXPECT_EQ(check.end == CheckEnd::None, !check.failed && !check.failed_after) << check.id;
    EXPECT_EQ(check.end == CheckEnd::Unexplained, check.failed_after) << check.id;
    failed += check.failed_after ? 1 : 0;
  }
  EXPECT_EQ(failed, report.failed_after);
  ASSERT_GE(failed, 1U);
  std::size_t told = 0;
  for (const Unexplained& left : report.unexplained) {
    told += left.checks.size();
  }
  EXPECT_EQ(told, failed);
}

/// Five rates at five levels, all of them Gaussian, passed every check: none compared one recording with another.
TEST(Checks, ALevelThatDiffersBetweenRecordingsFails) {
  World world(3, 4000);
  EXPECT_FALSE(check_called(world.report(), "gz.level").failed);
  world.raise(1, 0, 4000, 1.15);
  EXPECT_TRUE(check_called(world.report(), "gz.level").failed);
}

/// The threshold is that of a study: five causes of which one just reaches it share the 5 % between them.
TEST(Checks, CausesShareTheProbabilityOfTheThreshold) {
  const auto examined = examined_with({kThreshold, 1.0, 1.0, 1.0, 1.0});
  const Report report = World(1, 4000).report(examined);
  EXPECT_DOUBLE_EQ(check_called(report, "gz." + std::string(examined[0].cause->name)).p, 0.01);
}

/// A coarse lattice is plain to see, and its score only says that it is worth a word: with twenty checks beside it, it
/// was found because of a check that did not fail.
TEST(Checks, WhatTheFileShowsIsCertain) {
  auto examined = examined_with({1.0, 1.0});
  const auto& causes = cause_registry();
  const auto fact =
      std::find_if(causes.begin(), causes.end(), [](const Cause& c) { return c.as<FileFact>() != nullptr; });
  ASSERT_NE(fact, causes.end());
  examined[0].cause = &*fact;
  examined[0].score = kThreshold + 2.0;
  const Report report = World(3, 4000).report(examined);
  EXPECT_TRUE(check_called(report, "gz." + std::string(fact->name)).failed);
}

}  // namespace
}  // namespace driftlab::investigate
