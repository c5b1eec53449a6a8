#include "core/fit/sample_wise_variance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stop_token>

namespace driftlab {
namespace {

constexpr std::size_t kSamples = 8192;

Model model_of(std::initializer_list<std::pair<const char*, std::vector<double>>> parts) {
  Model model;
  for (const auto& [name, values] : parts) {
    model.push_back(*make_process(name, values));
  }
  return model;
}

std::vector<Model> truths() {
  return {model_of({{"white_noise", {1.0}}}),
          model_of({{"white_noise", {1.0}}, {"gauss_markov", {0.3, 0.02}}, {"random_walk", {0.001}}}),
          model_of({{"random_walk", {1.0}}}), model_of({{"quantization_noise", {1.0}}, {"white_noise", {0.3}}})};
}

HaarCovariance plan_for(std::size_t samples) {
  std::vector<std::size_t> half;
  for (std::size_t m = 1; 2 * m <= samples; m *= 2) {
    half.push_back(m);
  }
  return {half, samples, 1.0};
}

/// The estimate against the classical one on the series before it was spoiled: they differ by what the efficiency says,
/// four standard errors of it, and by `allowed` for an efficiency estimated from five draws.
void expect_like_the_good_series(const SampleWiseVariance& found, const std::vector<double>& good, const Model& truth,
                                 HaarCovariance& plan, double allowed) {
  ASSERT_EQ(found.outcome, SampleWiseOutcome::Estimated);
  const HaarVariance own = haar_variance(good, good.front());
  const Eigen::VectorXd variance = plan.diagonal(truth);
  for (std::size_t j = 0; j < own.scales(); ++j) {
    const double expected = haar_variance(truth, static_cast<double>(own.half[j]), 1.0);
    const double edf = 2.0 * expected * expected / variance(static_cast<Eigen::Index>(j));
    if (edf < 20.0) {
      break;
    }
    EXPECT_NEAR(found.curve.variance[j] / own.variance[j], 1.0,
                allowed + 4.0 * std::sqrt((1.0 / found.efficiency[j] - 1.0) * 2.0 / edf))
        << j;
  }
}

TEST(SampleWiseVariance, GrossErrorsLeaveEveryScaleOfEveryProcess) {
  struct Errors {
    double share;
    double size;
  };
  for (const Errors errors : {Errors{0.01, 100.0}, {0.001, 1000.0}, {0.05, 5.0}}) {
    for (const Model& truth : truths()) {
      Random random(41);
      const std::vector<double> good = simulate(truth, random, 1.0, kSamples);
      GappySamples spoiled{good, {}};
      for (double& value : spoiled.values) {
        value += random.uniform() < errors.share ? errors.size * random.normal() : 0.0;
      }
      HaarCovariance plan = plan_for(kSamples);
      const SampleWiseVariance found = sample_wise_variance(spoiled, plan);
      expect_like_the_good_series(found, good, truth, plan, 0.1);
      EXPECT_FALSE(found.flagged.empty());
      EXPECT_GT(found.replaced_share, 0.3 * errors.share);
      EXPECT_LT(found.replaced_share, 0.12);
    }
  }
}

TEST(SampleWiseVariance, ShiftedPatchesAreLeftOut) {
  const Model truth = truths()[0];
  Random random(42);
  const std::vector<double> good = simulate(truth, random, 1.0, kSamples);
  GappySamples spoiled{good, {}};
  for (const std::size_t start : {std::size_t{1000}, std::size_t{4000}, std::size_t{7000}}) {
    for (std::size_t k = 0; k < 50; ++k) {
      spoiled.values[start + k] += 5.0;
    }
  }
  HaarCovariance plan = plan_for(kSamples);
  const SampleWiseVariance found = sample_wise_variance(spoiled, plan);
  expect_like_the_good_series(found, good, truth, plan, 0.05);
  EXPECT_GE(found.flagged.size(), 150U);
  EXPECT_LE(found.flagged.size(), 300U);
}

TEST(SampleWiseVariance, GapsAtRandomAndInBurstsKeepTheVariances) {
  for (const Model& truth : truths()) {
    for (const std::size_t burst : {std::size_t{1}, std::size_t{50}}) {
      Random random(43);
      const std::vector<double> good = simulate(truth, random, 1.0, kSamples);
      GappySamples gappy{good, std::vector<std::uint8_t>(kSamples, 0)};
      for (std::size_t k = 0; k < kSamples / 20 / burst; ++k) {
        const std::size_t start = random.below(kSamples - burst);
        for (std::size_t t = start; t < start + burst; ++t) {
          gappy.missing[t] = 1;
          gappy.values[t] = std::numeric_limits<double>::quiet_NaN();  // never read
        }
      }
      HaarCovariance plan = plan_for(kSamples);
      const SampleWiseVariance found = sample_wise_variance(gappy, plan, {.look_for_errors = false});
      expect_like_the_good_series(found, good, truth, plan, 0.02);
      EXPECT_TRUE(found.flagged.empty());
      EXPECT_EQ(found.replaced_share, 0.0);
    }
  }
}

TEST(SampleWiseVariance, ACleanRecordIsLeftAlone) {
  for (const Model& truth : truths()) {
    Random random(44);
    const GappySamples good{simulate(truth, random, 1.0, kSamples), {}};
    HaarCovariance plan = plan_for(kSamples);
    const SampleWiseVariance found = sample_wise_variance(good, plan);
    const HaarVariance own = haar_variance(good.values, good.values.front());
    ASSERT_EQ(found.outcome, SampleWiseOutcome::Estimated);
    EXPECT_LT(found.replaced_share, 0.01);
    for (std::size_t j = 0; j < 8; ++j) {
      EXPECT_NEAR(found.curve.variance[j] / own.variance[j], 1.0, 0.01);
    }
  }
}

TEST(SampleWiseVariance, SaysWhereThereIsNoTruthToBeRobustFor) {
  // Every other sample five times as noisy: no core.
  Random random(45);
  GappySamples samples{std::vector<double>(kSamples), {}};
  for (std::size_t t = 0; t < kSamples; ++t) {
    samples.values[t] = (random.uniform() < 0.4 ? 10.0 : 1.0) * random.normal();
  }
  HaarCovariance plan = plan_for(kSamples);
  EXPECT_EQ(sample_wise_variance(samples, plan).outcome, SampleWiseOutcome::NotGaussian);
}

TEST(SampleWiseVariance, StrangeSeriesHaveAnOutcomeAndNeverNotANumber) {
  Random random(46);
  std::vector<GappySamples> strange;
  strange.push_back({{1.0, 2.0}, {}});
  strange.push_back({std::vector<double>(64, 3.0), {}});
  strange.push_back({std::vector<double>(64, 0.0), std::vector<std::uint8_t>(64, 1)});
  GappySamples impulse{std::vector<double>(512, 0.0), {}};
  impulse.values[100] = 1.0;
  strange.push_back(impulse);
  for (const double scale : {1e120, 1e-120}) {
    GappySamples extreme{std::vector<double>(512), {}};
    for (double& value : extreme.values) {
      value = scale * random.normal();
    }
    extreme.values[7] *= 1e10;
    strange.push_back(extreme);
  }
  GappySamples ramp{std::vector<double>(512), {}};
  GappySamples alternating{std::vector<double>(512), {}};
  GappySamples coarse{std::vector<double>(512), {}};
  for (std::size_t t = 0; t < 512; ++t) {
    ramp.values[t] = static_cast<double>(t);
    alternating.values[t] = t % 2 == 0 ? 1.0 : -1.0;
    coarse.values[t] = std::round(0.5 * random.normal());
  }
  strange.insert(strange.end(), {ramp, alternating, coarse});
  for (std::size_t n = 16; n < 40; ++n) {
    GappySamples& brief = strange.emplace_back();
    brief.values.resize(n);
    for (double& value : brief.values) {
      value = random.student(1.0);
    }
  }
  for (std::size_t i = 0; i < strange.size(); ++i) {
    HaarCovariance plan = plan_for(strange[i].size());
    const SampleWiseVariance found = sample_wise_variance(strange[i], plan);
    EXPECT_EQ(found.curve.variance.empty(), found.efficiency.empty());
    for (std::size_t j = 0; j < found.curve.variance.size(); ++j) {
      EXPECT_TRUE(std::isfinite(found.curve.variance[j]) && found.curve.variance[j] >= 0.0) << i;
      EXPECT_TRUE(found.efficiency[j] > 0.0 && found.efficiency[j] <= 1.0) << i << ' ' << found.efficiency[j];
    }
    if (found.outcome == SampleWiseOutcome::Estimated) {
      EXPECT_FALSE(found.curve.variance.empty()) << i;
    }
  }
  HaarCovariance pair = plan_for(2);
  EXPECT_EQ(sample_wise_variance(strange[0], pair).outcome, SampleWiseOutcome::TooFewSamples);
}

TEST(SampleWiseVariance, SameSeedSameBits) {
  Random random(47);
  GappySamples samples{simulate(truths()[1], random, 1.0, 3000), {}};
  samples.values[500] += 50.0;
  HaarCovariance plan = plan_for(3000);
  const auto a = sample_wise_variance(samples, plan, {.seed = 5});
  const auto b = sample_wise_variance(samples, plan, {.seed = 5});
  EXPECT_EQ(a.curve.variance, b.curve.variance);
  EXPECT_EQ(a.completed, b.completed);
}

TEST(SampleWiseVariance, StopsWhenAsked) {
  Random random(1);
  const GappySamples samples{simulate(truths()[0], random, 1.0, kSamples), {}};
  HaarCovariance plan = plan_for(kSamples);
  std::stop_source source;
  source.request_stop();
  const RunControl stopped{.stop = source.get_token(), .progress = {}};
  EXPECT_EQ(sample_wise_variance(samples, plan, {}, stopped).outcome, SampleWiseOutcome::Cancelled);
}

}  // namespace
}  // namespace driftlab
