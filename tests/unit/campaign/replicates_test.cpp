#include "core/campaign/replicates.hpp"

#include "core/fit/characterise.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

std::vector<double> make(const Model& model, double dt_s, std::size_t samples, std::uint64_t stream) {
  Random random(41, stream);
  return simulate(model, random, dt_s, samples);
}

WaveletRecord record(const std::vector<double>& x, double dt_s) {
  const HaarVariance curve = haar_variance(x, summarise(x)->mean);
  return {curve.half, curve.variance, {}, curve.samples, dt_s};
}

Model white_and_markov(double n, double sigma, double beta) {
  return {*make_process("white_noise", {n}), *make_process("gauss_markov", {sigma, beta})};
}

double log_width(const FittedParameter& parameter) {
  return std::log(parameter.estimate->ci95.high / parameter.estimate->ci95.low);
}

TEST(Replicates, OneRecordingIsFittedAsEver) {
  const auto x = make(white_and_markov(0.02, 0.05, 0.5), 0.01, 30000, 0);
  const auto alone = characterise_channel({.values = x, .dt_s = 0.01}, {.models = {"WN+GM"}});
  auto stack = Replicates::stack({record(x, 0.01)});
  Candidate fit = stack->fit(*parse_model("WN+GM"));
  const ModelFit joint = stack->report(fit, IntervalMethod::Profile);
  EXPECT_FALSE(stack->agreement(fit));
  for (std::size_t p = 0; p < 2; ++p) {
    const FittedParameter& a = alone->fits[0].processes[p].parameters[0];
    const FittedParameter& b = joint.processes[p].parameters[0];
    EXPECT_NEAR(b.estimate->value / a.estimate->value, 1.0, 1e-6);
    EXPECT_NEAR(log_width(b) / log_width(a), 1.0, 1e-3);
  }
  EXPECT_NEAR(joint.wic, alone->fits[0].wic, 1e-3);
}

TEST(Replicates, FourRecordingsHalveTheIntervals) {
  const Model truth = white_and_markov(0.02, 0.05, 0.5);
  std::vector<WaveletRecord> records;
  for (std::uint64_t i = 0; i < 4; ++i) {
    records.push_back(record(make(truth, 0.01, 30000, i), 0.01));
  }
  auto one = Replicates::stack({records[0]});
  auto four = Replicates::stack(records);
  Candidate single = one->fit(*parse_model("WN+GM"));
  Candidate joint = four->fit(*parse_model("WN+GM"));
  const ModelFit alone = one->report(single, IntervalMethod::Profile);
  const ModelFit pooled = four->report(joint, IntervalMethod::Profile);
  EXPECT_EQ(four->samples(), 120000.0);
  // Widths follow 1/sqrt(R); sigma and beta of 150 correlation times leave some 15 % of scatter in a width.
  EXPECT_NEAR(log_width(pooled.processes[0].parameters[0]) / log_width(alone.processes[0].parameters[0]), 0.5, 0.03);
  EXPECT_NEAR(log_width(pooled.processes[1].parameters[0]) / log_width(alone.processes[1].parameters[0]), 0.5, 0.15);
  EXPECT_NEAR(log_width(pooled.processes[1].parameters[1]) / log_width(alone.processes[1].parameters[1]), 0.5, 0.15);
  EXPECT_GT(four->agreement(joint)->p, 1e-4);
  EXPECT_EQ(four->agreement(joint)->dof, 9.0);
}

TEST(Replicates, RecordingsOfDifferentRatesAndLengthsShareTheirParameters) {
  const Model truth = white_and_markov(0.02, 0.05, 0.5);
  auto stack = Replicates::stack({record(make(truth, 0.01, 60000, 0), 0.01), record(make(truth, 0.05, 9000, 1), 0.05)});
  Candidate joint = stack->fit(*parse_model("WN+GM"));
  const ModelFit fit = stack->report(joint, IntervalMethod::Profile);
  // N of 60,000 white samples: 0.4 % by Fisher information; three interval widths are some six standard errors.
  const Estimate n = *fit.processes[0].parameters[0].estimate;
  EXPECT_NEAR(n.value, 0.02, 1.5 * (n.ci95.high - n.ci95.low));
  const Estimate beta = *fit.processes[1].parameters[1].estimate;
  EXPECT_NEAR(beta.value, 0.5, 1.5 * (beta.ci95.high - beta.ci95.low));
  EXPECT_GT(stack->agreement(joint)->p, 1e-4);
}

TEST(Replicates, TheOrderOfRecordingsOfTwoKindsDoesNotMatter) {
  const Model truth = white_and_markov(0.02, 0.05, 0.5);
  const WaveletRecord fast = record(make(truth, 0.01, 30000, 0), 0.01);
  const WaveletRecord slow = record(make(truth, 0.04, 8000, 1), 0.04);
  const WaveletRecord again = record(make(truth, 0.01, 30000, 2), 0.01);
  std::vector<Model> found;
  for (const std::vector<WaveletRecord>& order :
       {std::vector{fast, slow, again}, {fast, again, slow}, {slow, again, fast}}) {
    auto stack = Replicates::stack(order);
    const Candidate fit = stack->fit(*parse_model("WN+GM"));
    ASSERT_NE(fit.log_fit, nullptr);
    found.push_back(fit.log_fit->model());
  }
  for (const Model& other : found) {
    ASSERT_EQ(other.size(), 2U);
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t k = 0; k < other[p].parameters.size(); ++k) {
        EXPECT_NEAR(other[p].parameters[k] / found[0][p].parameters[k], 1.0, 1e-6) << p << ' ' << k;
      }
    }
  }
}

TEST(Replicates, DisagreementIsSeen) {
  const auto a = record(make(white_and_markov(0.02, 0.05, 0.5), 0.01, 30000, 0), 0.01);
  const auto b = record(make(white_and_markov(0.022, 0.05, 0.5), 0.01, 30000, 1), 0.01);
  auto stack = Replicates::stack({a, b});
  Candidate joint = stack->fit(*parse_model("WN+GM"));
  // N differs by 10 % and is known to 0.6 % in each: fifteen standard errors.
  EXPECT_LT(stack->agreement(joint)->p, 1e-6);
}

TEST(Replicates, AgreementHoldsItsSize) {
  // 100 pairs: a 5 % share has a standard error of 2.2 points. The long table is in tests/ACCURACY.md.
  const Model truth{*make_process("white_noise", {0.02}), *make_process("random_walk", {0.01})};
  int rejected = 0;
  for (std::uint64_t run = 0; run < 100; ++run) {
    auto stack = Replicates::stack(
        {record(make(truth, 0.01, 2000, 2 * run), 0.01), record(make(truth, 0.01, 2000, 2 * run + 1), 0.01)});
    const Candidate joint = stack->fit(*parse_model("WN+RW"));
    rejected += stack->agreement(joint)->p < 0.05 ? 1 : 0;
  }
  EXPECT_LE(rejected, 12);
}

TEST(Replicates, InflationWidensIntervals) {
  WaveletRecord plain = record(make({*make_process("white_noise", {0.02})}, 0.01, 30000, 0), 0.01);
  WaveletRecord robust = plain;
  robust.inflation.assign(plain.half.size(), 1.0 / 0.6);
  auto first = Replicates::stack({plain});
  auto second = Replicates::stack({robust});
  Candidate a = first->fit(*parse_model("WN"));
  Candidate b = second->fit(*parse_model("WN"));
  const double width = log_width(first->report(a, IntervalMethod::Profile).processes[0].parameters[0]);
  const double wider = log_width(second->report(b, IntervalMethod::Profile).processes[0].parameters[0]);
  EXPECT_NEAR(wider / width, std::sqrt(1.0 / 0.6), 0.02);
}

TEST(Replicates, GivesNoNameToWhatIsLeftOfTwoAlike) {
  // White noise and one Gauss-Markov process fitted with two: one vanishes, or both share one curve.
  const Model truth = white_and_markov(0.02, 0.05, 0.5);
  auto stack = Replicates::stack({record(make(truth, 0.01, 30000, 0), 0.01)});
  Candidate fit = stack->fit(*parse_model("WN+2GM"));
  const ModelFit told = stack->report(fit, IntervalMethod::Preview);
  const bool vanished = !(fit.fit.model[1].parameters[0] > 0.0) || !(fit.fit.model[2].parameters[0] > 0.0);
  const bool white = fit.fit.model[1].parameters[1] * 0.01 > 1.0;
  ASSERT_TRUE(vanished || white) << "this seed shows two processes";
  for (std::size_t p = 1; p <= 2; ++p) {
    EXPECT_FALSE(told.processes[p].parameters[0].estimate);
    EXPECT_FALSE(told.processes[p].parameters[0].reason.empty());
  }
  EXPECT_TRUE(told.processes[0].parameters[0].estimate || white);
}

TEST(Replicates, RefusesWhatIsNoRecording) {
  EXPECT_EQ(Replicates::stack({}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(Replicates::stack({WaveletRecord{{1, 2}, {0.0, 1.0}, {}, 100, 0.01}}).error().code,
            ErrorCode::TooFewSamples);
  EXPECT_EQ(Replicates::stack({WaveletRecord{{1, 2}, {1.0}, {}, 100, 0.01}}).error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace driftlab
