#include "core/navigate/outage_claims.hpp"
#include "core/navigate/outage_runs.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
  options.threads = 3;
  EXPECT_TRUE(same(one, *evaluate_outages(first_turn(), options)));
  options.seed = 43;
  EXPECT_FALSE(same(one, *evaluate_outages(first_turn(), options)));
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
}

}  // namespace
}  // namespace driftlab
