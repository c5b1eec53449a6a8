#include "core/variance/long_tau.hpp"

#include "core/process/registry.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/samples.hpp"
#include "core/variance/theo1.hpp"
#include "core/variance/total_variance.hpp"
#include "core/variance/variance_intervals.hpp"
#include "tests/reference_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>

namespace driftlab {
namespace {

/// The test suite of NIST SP 1065, section 12.4: a thousand numbers of a multiplicative congruential generator.
std::vector<double> nist_points() {
  std::vector<double> points;
  for (std::uint64_t n = 1234567890; points.size() < 1000; n = 16807 * n % 2147483647) {
    points.push_back(static_cast<double>(n) / 2147483647.0);
  }
  return points;
}

void expect_deviations(const nlohmann::json& entry, double tolerance, const std::function<double(std::size_t)>& of) {
  for (std::size_t i = 0; i < entry["m"].size(); ++i) {
    const auto m = entry["m"][i].get<std::size_t>();
    const auto expected = entry["deviation"][i].get<double>();
    EXPECT_NEAR(std::sqrt(of(m)), expected, tolerance * expected) << m;
  }
}

TEST(TotalVariance, IsWhatTheHandbookPrintsAndThePeerComputes) {
  const nlohmann::json reference = reference_values("nist_1000_points.json");
  const std::vector<double> x = nist_points();
  const auto found = [&](std::size_t m) { return total_variance(x, 0.5, std::vector{m})[0]; };
  expect_deviations(reference["published"]["totdev"], 3e-7, found);
  expect_deviations(reference["computed"]["totdev"], 1e-10, found);
}

TEST(Theo1, IsWhatTheHandbookPrintsAndThePeerComputes) {
  const nlohmann::json reference = reference_values("nist_1000_points.json");
  const std::vector<double> x = nist_points();
  const auto found = [&](std::size_t m) { return theo1(x, 0.5, m); };
  expect_deviations(reference["published"]["theo1"], 5e-5, found);
  expect_deviations(reference["computed"]["theo1"], 1e-10, found);
}

TEST(Theo1, OfBlocksIsThatOfTheSamplesWhereTheNoiseIsSlow) {
  // A random walk of 4,096 steps: blocks of 8 of the 512 samples of a window change what a window sees by some 1/64.
  Random random(3);
  std::vector<double> x = simulate(Model{*make_process("random_walk", {1.0})}, random, 1.0, 4096);
  const double mean = summarise(x)->mean;
  const Theo1Value blocks = theo1_at(x, mean, 512, 1.0);
  EXPECT_EQ(blocks.length, 512U);
  EXPECT_DOUBLE_EQ(blocks.tau_s, 384.0);
  EXPECT_NEAR(blocks.variance, theo1(x, mean, 512), 0.03 * blocks.variance);
}

struct Tally {
  double covered = 0.0;
  double sum = 0.0;
  double log_squares = 0.0;
};

/// Bias and coverage per tau, and what the intervals' degrees of freedom say of the scatter.
void expect_unbiased_with_intervals(const Model& model, std::size_t samples, bool theo) {
  constexpr std::size_t kRuns = 300;
  const HaarVariance grid = haar_variance(std::vector<double>(samples, 0.0), 0.0);
  HaarCovariance plan(grid.half, samples, 1.0);
  std::vector<Tally> tally;
  LongTauCurve last;
  for (std::size_t run = 0; run < kRuns; ++run) {
    Random random(61, run);
    const std::vector<double> x = simulate(model, random, 1.0, samples);
    const double mean = summarise(x)->mean;
    const VarianceIntervals intervals = variance_intervals(haar_variance(x, mean), plan);
    last = theo ? theo1_curve(x, mean, 1.0, intervals.mixture, 1.0) : total_curve(x, mean, 1.0, intervals.mixture, 1.0);
    tally.resize(last.tau_s.size());
    for (std::size_t k = 0; k < tally.size(); ++k) {
      const double truth = 2.0 * haar_variance(model, last.tau_s[k], 1.0);
      tally[k].covered += last.ci95[k].contains(truth) ? 100.0 / kRuns : 0.0;
      tally[k].sum += last.variance[k] / truth / kRuns;
    }
  }
  ASSERT_GE(tally.size(), 8U);
  for (std::size_t k = 0; k < tally.size(); ++k) {
    // Scatter of the mean of 300 ratios with that many degrees of freedom, and the noise type read off one record,
    // which at the longest tau is as good as unknown.
    const double error = std::sqrt(2.0 / last.edf[k] / kRuns);
    EXPECT_NEAR(tally[k].sum, 1.0, 4.0 * error + 0.06 + 0.1 * last.tau_s[k] / static_cast<double>(samples))
        << model.front().kind->symbol << " tau " << last.tau_s[k];
    EXPECT_GT(tally[k].covered, 90.0) << model.front().kind->symbol << " tau " << last.tau_s[k];
  }
}

class LongTau : public testing::TestWithParam<bool> {};

TEST_P(LongTau, IsTheAllanVarianceOfWhiteNoiseFlickerAndRandomWalk) {
  for (const Model& model : {Model{*make_process("white_noise", {1.0})}, Model{*make_process("flicker_noise", {1.0})},
                             Model{*make_process("random_walk", {1.0})},
                             Model{*make_process("white_noise", {1.0}), *make_process("random_walk", {0.02})}}) {
    expect_unbiased_with_intervals(model, 2048, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(TotalAndTheo1, LongTau, testing::Bool(),
                         [](const auto& which) { return which.param ? "Theo1" : "Total"; });

TEST(LongTauCurves, ReachFurtherThanTheAllanVarianceAndTotalKnowsMore) {
  Random random(5);
  const std::vector<double> x = simulate(Model{*make_process("white_noise", {1.0})}, random, 0.01, 10000);
  const HaarVariance curve = haar_variance(x, 0.0);
  HaarCovariance plan(curve.half, x.size(), 0.01);
  const VarianceIntervals intervals = variance_intervals(curve, plan);
  const LongTauCurve total = total_curve(x, 0.0, 1.0, intervals.mixture, 0.01);
  const LongTauCurve theo = theo1_curve(x, 0.0, 1.0, intervals.mixture, 0.01);
  EXPECT_DOUBLE_EQ(total.tau_s.back(), 50.0);
  EXPECT_NEAR(theo.tau_s.back(), 75.0, 1.5);
  EXPECT_GT(total.edf.back(), 1.5 * intervals.edf.back());
  EXPECT_GE(theo.edf.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(theo.tau_s.begin(), theo.tau_s.end()));
  EXPECT_TRUE(total_curve(std::span(x).first(31), 0.0, 1.0, intervals.mixture, 0.01).tau_s.empty());
}

}  // namespace
}  // namespace driftlab
