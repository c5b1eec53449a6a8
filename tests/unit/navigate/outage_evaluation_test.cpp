#include "core/navigate/outage_claims.hpp"
#include "core/navigate/outage_progress.hpp"
#include "core/navigate/outage_runs.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

/// The paper's first turn alone, all six filters.
OutageScenario first_turn() {
  OutageScenario scenario = *paper_scenario("paper");
  scenario.drive.duration_s = 102.0;
  std::erase_if(scenario.drive.segments, [](const Segment& s) { return s.start_s > 100.0; });
  scenario.outages.resize(1);
  return scenario;
}

bool same(const OutageEvaluation& a, const OutageEvaluation& b) {
  for (std::size_t f = 0; f < a.filters.size(); ++f) {
    if (a.filters[f].mean_error_m.value != b.filters[f].mean_error_m.value ||
        a.filters[f].nees.value != b.filters[f].nees.value ||
        a.filters[f].outages[0].scatter != b.filters[f].outages[0].scatter ||
        a.filters[f].path.north_m != b.filters[f].path.north_m) {
      return false;
    }
  }
  return a.runs == b.runs;
}

TEST(OutageEvaluation, IsTheSameForAnyNumberOfThreads) {
  OutageOptions options;
  options.runs = 7;
  options.seed = 42;
  const auto one = *evaluate_outages(first_turn(), options);
  for (const unsigned threads : {2U, 8U}) {
    Executor executor(threads);
    RunControl control;
    control.threads.executor = &executor;
    EXPECT_TRUE(same(one, *evaluate_outages(first_turn(), options, control))) << threads << " threads";
  }
  options.seed = 43;
  EXPECT_FALSE(same(one, *evaluate_outages(first_turn(), options)));
}

TEST(OutageBatches, AreTheEvaluationWhereverEachIsWorkedOut) {
  OutageOptions options;
  options.runs = 45;
  const auto whole = *evaluate_outages(first_turn(), options);
  auto here = *OutageBatches::make(first_turn(), options);
  const auto elsewhere = *OutageBatches::make(first_turn(), options);
  ASSERT_EQ(here.count(), 3U);
  const auto last = elsewhere.run(2, {});
  EXPECT_EQ(last->scores.size(), 5U);
  EXPECT_TRUE(last->drawn.paths.empty());
  EXPECT_TRUE(*here.add(*here.run(0, {})));
  EXPECT_FALSE(here.add(*last)) << "not the second batch";
  EXPECT_TRUE(*here.add(*elsewhere.run(1, {})));
  EXPECT_FALSE(*here.add(*last)) << "the last";
  EXPECT_TRUE(same(whole, here.evaluate()));
}

TEST(OutageBatches, EndWhereThePrecisionIsReached) {
  OutageOptions options;
  options.runs = 100;
  options.relative_precision = 0.5;
  const auto whole = *evaluate_outages(first_turn(), options);
  EXPECT_TRUE(whole.stopped_early);
  auto batches = *OutageBatches::make(first_turn(), options);
  std::size_t number = 0;
  while (*batches.add(*batches.run(number, {}))) {
    ++number;
  }
  EXPECT_LT(number + 1, batches.count());
  EXPECT_TRUE(same(whole, batches.evaluate()));
}

TEST(OutageEvaluation, ProcessNoiseAloneDoesNotChangeTheFirstOutage) {
  // Up to the first turn M_stat(AV) and M_dyn(AV) are one filter, and inside an outage process noise changes the
  // covariance, not the mean: the errors agree to the last bit. With Gauss-Markov states they do not.
  const OutageExperiment experiment = *OutageExperiment::make(first_turn());
  const auto scores = experiment.run(1, 0, nullptr);
  EXPECT_EQ(scores[0][0].north_m, scores[1][0].north_m);
  EXPECT_EQ(scores[0][0].east_m, scores[1][0].east_m);
  EXPECT_NE(scores[0][0].var_north, scores[1][0].var_north);
  EXPECT_NE(scores[0][0].north_m, scores[2][0].north_m);
}

TEST(OutageEvaluation, DrawsTheFirstRunAroundEachOutageAndChangesNothingByIt) {
  const OutageScenario scenario = first_turn();
  const OutageExperiment experiment = *OutageExperiment::make(scenario);
  DrawnRun drawn;
  const auto scores = experiment.run(1, 0, &drawn);
  EXPECT_EQ(scores[0][0].north_m, experiment.run(1, 0, nullptr)[0][0].north_m);
  const auto truth = experiment.true_tracks();
  ASSERT_EQ(truth.size(), scenario.outages.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Outage& outage = scenario.outages[i];
    const OutagePath& track = drawn.tracks[0][i];
    ASSERT_EQ(track.time_s, truth[i].time_s);
    EXPECT_NEAR(track.time_s.front(), outage.start_s - 10.0, 0.1 + 1e-9);
    EXPECT_NEAR(track.time_s[1] - track.time_s[0], 0.1, 1e-9);
    // At its end the track is as far from the truth as the score says. The score is taken before the returning fix, a
    // point of the same moment too.
    const auto end = std::min_element(track.time_s.begin(), track.time_s.end(),
                                      [&](double a, double b) {
                                        return std::fabs(a - outage.end_s()) < std::fabs(b - outage.end_s());
                                      }) -
                     track.time_s.begin();
    ASSERT_NEAR(track.time_s[static_cast<std::size_t>(end)], outage.end_s(), 1e-6);
    const auto at = static_cast<std::size_t>(end);
    EXPECT_NEAR(std::hypot(track.north_m[at] - truth[i].north_m[at], track.east_m[at] - truth[i].east_m[at]),
                scores[0][i].error_m(), 0.02);  // the plane of the start is turned by 1e-3 rad at some kilometres
  }
}

TEST(OutageEvaluation, TellsWhatIsKnownWhileItRuns) {
  OutageScenario scenario = first_turn();
  scenario.filters.resize(1);
  OutageOptions options;
  options.runs = 44;
  RunControl control;
  std::string last;
  control.progress = [&](std::string_view stage, double fraction) { last = fraction < 1.0 ? stage : last; };
  ASSERT_TRUE(evaluate_outages(scenario, options, control));
  EXPECT_TRUE(last.starts_with("outages, mean after 40 runs: " + scenario.filters[0].name + " ")) << last;
  EXPECT_TRUE(last.ends_with("]")) << last;
  const auto known = outages_so_far(last);
  ASSERT_TRUE(known) << last;
  EXPECT_EQ(known->runs, 40U);
  ASSERT_EQ(known->filters.size(), 1U);
  EXPECT_EQ(known->filters[0].name, scenario.filters[0].name);
  options.runs = 40;
  const auto after = evaluate_outages(scenario, options);
  ASSERT_TRUE(after);
  // Rounded to the digit that the interval lets stand: half a unit of it is less than a third of the half-width.
  const Estimate& mean = after->filters[0].mean_error_m;
  const double rounding = (mean.ci95.high - mean.ci95.low) / 2.0;
  EXPECT_NEAR(known->filters[0].error_m.value, mean.value, rounding / 2.0);
  EXPECT_NEAR(known->filters[0].error_m.ci95.low, mean.ci95.low, rounding / 2.0);
  EXPECT_NEAR(known->filters[0].error_m.ci95.high, mean.ci95.high, rounding / 2.0);
}

TEST(OutagesSoFar, AreReadBackFromTheirSentenceAlone) {
  const OutagesSoFar known{1000, {{"M 1, first", {12.0, {10.0, 14.0}}}, {"M_dyn(GMWM)", {0.5, {-0.2, 1.2}}}}};
  const auto read = outages_so_far(stage_of(known));
  ASSERT_TRUE(read) << stage_of(known);
  EXPECT_EQ(read->runs, 1000U);
  ASSERT_EQ(read->filters.size(), 2U);
  EXPECT_EQ(read->filters[0].name, "M 1, first");
  EXPECT_DOUBLE_EQ(read->filters[0].error_m.ci95.high, 14.0);
  EXPECT_EQ(read->filters[1].name, "M_dyn(GMWM)");
  EXPECT_DOUBLE_EQ(read->filters[1].error_m.ci95.low, -0.2);
  for (const char* const stage :
       {"", "outages", "trajectory", "outages, mean after 40 runs:", "outages, mean after 40 runs: M",
        "outages, mean after 40 runs: M 1 m [0, 2", "outages, mean after many runs: M 1 m [0, 2]",
        "outages, mean after 40 runs: M 1 m [0, 2], ", "outages, mean after 40 runs: M 1 m [0, 2]x, "}) {
    EXPECT_FALSE(outages_so_far(stage)) << stage;
  }
}

TEST(OutageEvaluation, PairsAreMirrorImages) {
  OutageOptions options;
  options.runs = 5;
  const auto evaluation = *evaluate_outages(first_turn(), options);
  const auto pair = *evaluation.difference("M_dyn(GMWM)", "M_stat(AV)");
  const auto mirror = *evaluation.difference("M_stat(AV)", "M_dyn(GMWM)");
  EXPECT_DOUBLE_EQ(pair.difference_m.value, -mirror.difference_m.value);
  EXPECT_DOUBLE_EQ(pair.difference_m.ci95.low, -mirror.difference_m.ci95.high);
  EXPECT_NEAR((1.0 + pair.relative.value) * (1.0 + mirror.relative.value), 1.0, 1e-12);
  EXPECT_FALSE(evaluation.difference("M_dyn(GMWM)", "nobody"));
  // The parts of the attribution add up to the whole.
  const auto parts = *attribute(evaluation);
  EXPECT_NEAR(parts.low_frequency_noise.difference_m.value + parts.gauss_markov_states.difference_m.value +
                  parts.switching.difference_m.value,
              parts.total.difference_m.value, 1e-12);
  EXPECT_EQ(judge_claims(evaluation).size(), 6U);
}

TEST(OutageEvaluation, StopsOnceItIsPreciseAndWhenAsked) {
  OutageScenario scenario = first_turn();
  scenario.filters.resize(1);
  scenario.imu_rate_hz = 20.0;
  OutageOptions options;
  options.runs = 400;
  options.relative_precision = 0.3;
  const auto evaluation = *evaluate_outages(scenario, options);
  EXPECT_TRUE(evaluation.stopped_early);
  EXPECT_LT(evaluation.runs, 400);
  EXPECT_EQ(evaluation.runs % 20, 0);
  const Estimate& mean = evaluation.filters[0].mean_error_m;
  EXPECT_LE(mean.ci95.high - mean.value, 0.3 * mean.value);

  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  double last = -1.0;
  control.progress = [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    if (fraction > 0.01) {
      source.request_stop();
    }
  };
  EXPECT_EQ(evaluate_outages(scenario, options, control).error().code, ErrorCode::Cancelled);
}

TEST(OutageEvaluation, IntervalsHoldWhatAnotherSeedFinds) {
  // A relative statement about two independent evaluations: their difference lies within the root of the summed squared
  // half-widths, times 1.5 (three standard deviations).
  OutageScenario scenario = first_turn();
  scenario.filters.resize(1);
  scenario.imu_rate_hz = 20.0;
  OutageOptions options;
  options.runs = 60;
  const Estimate a = evaluate_outages(scenario, options)->filters[0].mean_error_m;
  options.seed = 2;
  const Estimate b = evaluate_outages(scenario, options)->filters[0].mean_error_m;
  EXPECT_LT(std::fabs(a.value - b.value), 1.5 * std::hypot(a.ci95.high - a.value, b.ci95.high - b.value));
}

TEST(OutageEvaluation, ScoresAreEllipsesAndDistances) {
  OutageScore score;
  score.north_m = 3.0;
  score.east_m = 4.0;
  score.var_north = 9.0;
  score.var_east = 16.0;
  EXPECT_DOUBLE_EQ(score.error_m(), 5.0);
  EXPECT_DOUBLE_EQ(score.nees(), 2.0);
}

TEST(PaperScenario, HasTheStatedFiltersAndVariants) {
  for (const std::string& name : scenario_names()) {
    const OutageScenario scenario = *paper_scenario(name);
    ASSERT_TRUE(check(scenario)) << name;
    ASSERT_EQ(scenario.filters.size(), 6U);
    ASSERT_EQ(scenario.outages.size(), 4U);
    EXPECT_EQ(scenario.filters[0].settings.use_velocity, name != "paper-position-only");
    EXPECT_EQ(scenario.filters[0].settings.non_holonomic.has_value(), name == "paper-nhc");
  }
  const FilterDesign design = *FilterDesign::make(paper_scenario("paper")->filters[2].settings, 0.01);
  // 9 + gyro 3 x (bias + 2 GM) + accelerometer 3 x (bias + GM).
  EXPECT_EQ(9 + design.sensor_states(), 24);
  EXPECT_EQ(paper_scenario("nowhere").error().code, ErrorCode::NotFound);
}

TEST(PaperScenario, HoldsTheNumbersOfThePaper) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr double kPerRootHour = kDegree / 60.0;
  const OutageScenario scenario = *paper_scenario("paper");
  const auto z_of = [&](std::size_t filter) { return scenario.filters[filter].settings.imu.axes[2]; };
  // Tables 1 and 2: N of the iPhone at rest, 9, 18 and 36 deg/s; Table 5: bands of |z| to 5, 15, 25 deg/s.
  EXPECT_NEAR(z_of(0).processes.model(0)[0].parameters[0], 1.0978 * kPerRootHour, 1e-12);
  EXPECT_EQ(z_of(0).processes.size(), 1U);
  const ModelSchedule dynamic = z_of(1).processes;
  ASSERT_EQ(dynamic.size(), 4U);
  constexpr std::array kN{1.0978, 1.1788, 1.702, 2.4233};
  constexpr std::array kBounds{5.0, 15.0, 25.0};
  for (std::size_t band = 0; band < 4; ++band) {
    EXPECT_NEAR(dynamic.model(band)[0].parameters[0], kN[band] * kPerRootHour, 1e-12);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(dynamic.bounds_rad_s()[i], kBounds[i] * kDegree, 1e-12);
    EXPECT_NEAR(z_of(2).processes.bounds_rad_s()[i], kBounds[i] * kDegree, 1e-12);
    EXPECT_NEAR(scenario.truth.axes[2].processes.bounds_rad_s()[i], kBounds[i] * kDegree, 1e-12);
  }
  // Table 4, experiment 0: N = 1.034, beta1 = 1.7101, sigma1^2 = 7.049, beta2 = 9.7259e-3, sigma2^2 = 1.0601 in
  // (deg/sqrt(h))^2, read as sigma[deg/s] = sqrt(value)/60; experiment 3 likewise.
  const Model rest = scenario.truth.axes[2].processes.model(0);
  const double sigma1 = std::sqrt(7.049) * kPerRootHour;
  const double sigma2 = std::sqrt(1.0601) * kPerRootHour;
  EXPECT_NEAR(rest[0].parameters[0], 1.034 * kPerRootHour, 1e-12);
  EXPECT_NEAR(rest[1].parameters[0], sigma1, 1e-12);
  EXPECT_NEAR(rest[1].parameters[1], 1.7101, 1e-12);
  EXPECT_NEAR(rest[2].parameters[0], sigma2, 1e-12);
  EXPECT_NEAR(rest[2].parameters[1], 9.7259e-3, 1e-12);
  const Model fast = z_of(2).processes.model(3);
  EXPECT_NEAR(fast[0].parameters[0], 1.7224 * kPerRootHour, 1e-12);
  EXPECT_NEAR(fast[1].parameters[0], std::sqrt(18.4464) * kPerRootHour, 1e-12);
  EXPECT_NEAR(fast[2].parameters[1], 1.4675e-2, 1e-12);
  // The controls: q = sigma2 sqrt(2 beta2) [deg/s/sqrt(s)], N_eq = sqrt(N^2 + 2 sigma1^2/beta1).
  const double q = std::sqrt(1.0601) / 60.0 * std::sqrt(2.0 * 9.7259e-3) * kDegree;
  EXPECT_NEAR(q / kDegree, 2.3933e-3, 1e-6);
  EXPECT_NEAR(z_of(4).processes.model(0)[1].parameters[0], q, 1e-12);
  EXPECT_NEAR(z_of(4).processes.model(0)[0].parameters[0], 1.0978 * kPerRootHour, 1e-12);
  const double n_eq = std::sqrt(1.034 * 1.034 + 2.0 * 7.049 / 1.7101);
  EXPECT_NEAR(n_eq, 3.0517, 1e-4);
  EXPECT_NEAR(z_of(5).processes.model(0)[0].parameters[0], n_eq * kPerRootHour, 1e-12);
  EXPECT_NEAR(z_of(5).processes.model(0)[1].parameters[0], q, 1e-12);
}

TEST(OutageEvaluation, AMatchedFilterKnowsItsEllipsesAndItsAngles) {
  // The truth's filter through one turn. Heading and tilt of the errors against what draws of them start from: a drive
  // without a turn leaves the heading at the 3 deg it began with, and fixes of velocity while turning improve it.
  OutageScenario scenario = first_turn();
  scenario.imu_rate_hz = 20.0;
  scenario.filters = {scenario.filters[2]};
  scenario.filters[0].settings.covariance_samples = 2;
  OutageOptions options;
  options.runs = 200;
  const FilterEvaluation filter = evaluate_outages(scenario, options)->filters[0];
  // Binomial, 200 runs: four standard deviations.
  EXPECT_NEAR(filter.coverage50, 0.50, 4.0 * std::sqrt(0.25 / 200.0));
  EXPECT_NEAR(filter.coverage95, 0.95, 4.0 * std::sqrt(0.95 * 0.05 / 200.0));
  EXPECT_EQ(filter.coverage50, filter.outages[0].coverage50) << "of one outage the whole is the part";
  // The root mean squares are those of the scores of single runs.
  const OutageExperiment experiment = *OutageExperiment::make(scenario);
  double heading = 0.0;
  double tilt = 0.0;
  double inside = 0.0;
  for (std::uint64_t run = 0; run < 200; ++run) {
    const OutageScore score = experiment.run(options.seed, run, nullptr)[0][0];
    heading += score.heading_rad * score.heading_rad / 200.0;
    tilt += score.tilt_rad * score.tilt_rad / 200.0;
    inside += score.nees() <= -2.0 * std::log(1.0 - 0.5) ? 1.0 / 200.0 : 0.0;  // chi-square of 2 degrees of freedom
  }
  EXPECT_NEAR(filter.heading_rms_rad, std::sqrt(heading), 1e-12);
  EXPECT_NEAR(filter.tilt_rms_rad, std::sqrt(tilt), 1e-12);
  EXPECT_NEAR(filter.coverage50, inside, 1e-12);
  constexpr double kDegree = std::numbers::pi / 180.0;
  EXPECT_LT(filter.heading_rms_rad, 10.0 * kDegree);
  EXPECT_GT(filter.heading_rms_rad, 0.1 * kDegree);
  // 10 mg of bias that tilt and accelerometer share: 0.57 deg, less what the turn tells apart.
  EXPECT_LT(filter.tilt_rms_rad, 1.0 * kDegree);
  EXPECT_GT(filter.tilt_rms_rad, 0.1 * kDegree);
}

TEST(OutageScenario, RefusesWhatCannotBeEvaluated) {
  OutageScenario scenario = first_turn();
  scenario.outages = {{90.0, 20.0}};
  EXPECT_EQ(check(scenario).error().code, ErrorCode::InvalidArgument);
  scenario = first_turn();
  scenario.filters[1].name = scenario.filters[0].name;
  EXPECT_EQ(check(scenario).error().code, ErrorCode::InvalidArgument);
  scenario = first_turn();
  scenario.outages.clear();
  EXPECT_EQ(check(scenario).error().code, ErrorCode::InvalidArgument);
  scenario.outages.resize(kMostOutages + 1);
  EXPECT_EQ(check(scenario).error().message, "A scenario has at most 1000 outages.");
  // What the parts would refuse later is found at once.
  scenario = first_turn();
  scenario.drive.segments[1].duration_s = 0.0;
  EXPECT_EQ(check(scenario).error().fields.front().name, "segment");
  scenario = first_turn();
  scenario.filters[1].settings.imu.axes[0].processes =
      ModelSchedule::constant({*make_process("flicker_noise", {1e-4}), *make_process("flicker_noise", {1e-4})});
  EXPECT_EQ(check(scenario).error().fields.back().value, scenario.filters[1].name);
  scenario = first_turn();
  scenario.drive.duration_s = 2000.0;
  scenario.imu_rate_hz = 10000.0;
  EXPECT_EQ(check(scenario).error().code, ErrorCode::LimitExceeded);
}

TEST(OutageScenario, IsCompletedByWhatStandsForItsTrajectoryAndOutages) {
  WrittenScenario written;
  written.scenario.drive.segments = {{.kind = SegmentKind::Turn, .start_s = 30.0},
                                     {.kind = SegmentKind::Straight, .start_s = 40.0},
                                     {.kind = SegmentKind::Turn, .start_s = 50.0}};
  written.scenario.drive.duration_s = 60.0;
  EXPECT_TRUE(completed(written).outages.empty());
  written.at_turns_s = 5.0;
  const OutageScenario turns = completed(written);
  ASSERT_EQ(turns.outages.size(), 2U);
  EXPECT_EQ(turns.outages[1].start_s, 50.0);
  EXPECT_EQ(turns.outages[1].duration_s, 5.0);
  EXPECT_EQ(turns.drive.duration_s, 60.0);

  WrittenScenario recorded;
  recorded.recorded.poses.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    recorded.recorded.poses[i].time_s = 100.0 + static_cast<double>(i);
    recorded.recorded.poses[i].velocity_ned_m_s = {0.0, 10.0, 0.0};
  }
  EXPECT_EQ(completed(recorded).recorded[3].attitude.heading_rad, 0.0) << "it was recorded so";
  recorded.recorded.unknown.heading = true;
  const OutageScenario drive = completed(recorded);
  EXPECT_EQ(drive.drive.duration_s, 3.0);
  EXPECT_NEAR(drive.recorded[3].attitude.heading_rad, std::numbers::pi / 2.0, 1e-12);
}

}  // namespace
}  // namespace driftlab
