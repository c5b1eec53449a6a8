#include "core/fit/characterise.hpp"

#include "core/process/model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stop_token>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<double> make(const Model& model, std::size_t samples, std::uint64_t seed) {
  Random random(seed);
  return simulate(model, random, kDt, samples);
}

Model model_of(std::initializer_list<std::pair<const char*, std::vector<double>>> parts) {
  Model model;
  for (const auto& [name, values] : parts) {
    model.push_back(*make_process(name, values));
  }
  return model;
}

const FittedParameter& parameter(const ModelFit& fit, std::size_t process, std::size_t index) {
  return fit.processes.at(process).parameters.at(index);
}

TEST(Characterise, WhiteNoiseComesBackAsWhiteNoise) {
  const auto x = make(model_of({{"white_noise", {0.02}}}), 1 << 16, 11);
  const auto result = characterise_channel({.values = x, .dt_s = kDt});
  ASSERT_TRUE(result.has_value());
  const ModelFit& best = result->fits.at(result->best);
  EXPECT_EQ(best.model, "WN");
  EXPECT_EQ(best.status, "converged");
  ASSERT_TRUE(parameter(best, 0, 0).estimate.has_value());
  // Relative standard error of N from 65,536 independent samples is about 1/sqrt(2 * 65536) = 0.28 %.
  EXPECT_NEAR(parameter(best, 0, 0).estimate->value, 0.02, 0.02 * 0.012);
  EXPECT_EQ(result->haar.scale.size(), 16U);
  EXPECT_EQ(result->fits.size(), 9U);
  ASSERT_TRUE(result->allan_parameters.n.has_value());
  EXPECT_NEAR(result->allan_parameters.n->value, 0.02, 0.02 * 0.02);
  EXPECT_FALSE(result->allan_parameters.k.has_value()) << "no random walk is there";
  EXPECT_FALSE(result->allan_parameters.k_reason.empty());
}

TEST(Characterise, FindsTheGaussMarkovProcessInWhiteNoise) {
  const auto x = make(model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.05, 0.5}}}), 200000, 5);
  const auto result = characterise_channel({.values = x, .dt_s = kDt});
  ASSERT_TRUE(result.has_value());
  const ModelFit& best = result->fits.at(0);
  EXPECT_EQ(best.model, "WN+GM");
  // 1,000 correlation times: sigma to some 2.5 %, beta to some 7 % (Fisher information). One seed proves no coverage
  // (that is tests/accuracy); two interval widths are four standard errors.
  const Estimate sigma = *parameter(best, 1, 0).estimate;
  const Estimate beta = *parameter(best, 1, 1).estimate;
  EXPECT_NEAR(sigma.value, 0.05, sigma.ci95.high - sigma.ci95.low);
  EXPECT_NEAR(beta.value, 0.5, beta.ci95.high - beta.ci95.low);
  EXPECT_NEAR((beta.ci95.high - beta.ci95.low) / (2 * 1.96 * beta.value), 0.07, 0.02);
  EXPECT_GT(best.j_test->p, 0.001);
}

TEST(Characterise, SiFactorScalesEveryLevelOnce) {
  const auto x = make(model_of({{"white_noise", {0.02}}, {"random_walk", {0.01}}}), 30000, 2);
  const CharacteriseOptions options{.models = {"WN+RW"}};
  const auto plain = characterise_channel({.values = x, .dt_s = kDt}, options);
  const auto scaled = characterise_channel({.values = x, .dt_s = kDt, .si_factor = 1e-3}, options);
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_NEAR(parameter(scaled->fits[0], p, 0).estimate->value,
                1e-3 * parameter(plain->fits[0], p, 0).estimate->value, 1e-12);
  }
  for (std::size_t j = 0; j < plain->haar.variance.size(); ++j) {
    EXPECT_NEAR(scaled->haar.variance[j], 1e-6 * plain->haar.variance[j], 1e-18);
    EXPECT_EQ(2.0 * scaled->haar.variance[j], scaled->allan.variance[j]);
  }
  EXPECT_NEAR(scaled->mean, 1e-3 * plain->mean, 1e-15);
}

TEST(Characterise, TwoGaussMarkovProcessesComeFastestFirst) {
  const auto x = make(
      model_of({{"white_noise", {0.001}}, {"gauss_markov", {0.05, 0.05}}, {"gauss_markov", {0.05, 5.0}}}), 400000, 9);
  const auto result = characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN+2GM"}});
  const ModelFit& fit = result->fits.at(0);
  ASSERT_TRUE(parameter(fit, 1, 1).estimate && parameter(fit, 2, 1).estimate);
  EXPECT_GT(parameter(fit, 1, 1).estimate->value, parameter(fit, 2, 1).estimate->value);
}

TEST(Characterise, SameInputGivesTheSameBits) {
  const auto x = make(model_of({{"white_noise", {0.02}}, {"random_walk", {0.01}}}), 20000, 2);
  const auto a = characterise_channel({.values = x, .dt_s = kDt});
  const auto b = characterise_channel({.values = x, .dt_s = kDt});
  for (std::size_t i = 0; i < a->fits.size(); ++i) {
    EXPECT_EQ(a->fits[i].wic, b->fits[i].wic);
    EXPECT_EQ(a->fits[i].model, b->fits[i].model);
  }
}

TEST(Characterise, ConstantChannelIsZeroWithAWarning) {
  const std::vector<double> x(100, 3.25);
  const auto result = characterise_channel({.values = x, .dt_s = kDt});
  ASSERT_TRUE(result.has_value());
  EXPECT_THAT(result->haar.variance, testing::Each(0.0));
  EXPECT_TRUE(result->fits.empty());
  EXPECT_EQ(result->warnings.size(), 1U);
  EXPECT_EQ(result->mean, 3.25);
}

TEST(Characterise, RefusesWhatItCannotAnalyse) {
  std::vector<double> x(100, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::sin(static_cast<double>(i * i));
  }
  const auto code = [&](const std::vector<double>& values, double dt = kDt) {
    const auto result = characterise_channel({.values = values, .dt_s = dt});
    return result ? ErrorCode::Internal : result.error().code;
  };
  EXPECT_EQ(code({1.0, 2.0}), ErrorCode::TooFewSamples);
  EXPECT_EQ(code({}), ErrorCode::TooFewSamples);
  EXPECT_EQ(code(x, 0.0), ErrorCode::InvalidArgument);
  EXPECT_EQ(code(x, std::nan("")), ErrorCode::InvalidArgument);
  auto bad = x;
  bad[41] = std::nan("");
  const auto nan = characterise_channel({.values = bad, .dt_s = kDt});
  EXPECT_EQ(nan.error().code, ErrorCode::NonFinite);
  EXPECT_THAT(nan.error().fields, testing::Contains(ErrorField{"row", "42"}));
  bad[41] = 1e200;
  EXPECT_EQ(code(bad), ErrorCode::OutOfRange);
  EXPECT_EQ(code(std::vector<double>(50, std::nan(""))), ErrorCode::NonFinite);
  auto tiny = x;
  for (double& value : tiny) {
    value *= 1e-200;
  }
  EXPECT_EQ(code(tiny), ErrorCode::OutOfRange);
}

bool finite(const ChannelCharacterisation& result) {
  const auto good = [](double value) { return !std::isnan(value); };
  bool all = true;
  for (std::size_t j = 0; j < result.haar.variance.size(); ++j) {
    all = all && good(result.haar.variance[j]) && good(result.haar.ci95[j].low) && good(result.haar.ci95[j].high) &&
          good(result.haar.edf[j]);
  }
  for (const ModelFit& fit : result.fits) {
    all = all && good(fit.objective) && good(fit.wic) && good(fit.eq8) && (!fit.j_test || good(fit.j_test->p));
    for (const FittedProcess& process : fit.processes) {
      for (const FittedParameter& p : process.parameters) {
        all = all && (p.estimate.has_value() != !p.reason.empty());
        all = all && (!p.estimate || (good(p.estimate->value) && p.estimate->ci95.contains(p.estimate->value)));
      }
    }
  }
  return all;
}

TEST(Characterise, StrangeSeriesNeverGiveNotANumber) {
  Random random(1);
  std::vector<std::vector<double>> series;
  series.reserve(32);                            // references to its elements are kept below
  series.emplace_back(1000, 0.0).at(500) = 1.0;  // one impulse
  series.emplace_back(1000, 0.0).back() = 1e-9;
  auto& alternating = series.emplace_back(512);  // no variance at all above the first scale
  auto& step = series.emplace_back(777);
  auto& ramp = series.emplace_back(300);
  auto& huge = series.emplace_back(64);
  auto& sine = series.emplace_back(4096);
  for (std::size_t i = 0; i < 4096; ++i) {
    const double t = static_cast<double>(i);
    if (i < alternating.size()) {
      alternating[i] = i % 2 == 0 ? 1.0 : -1.0;
    }
    if (i < step.size()) {
      step[i] = i < 300 ? 0.0 : 1.0;
    }
    if (i < ramp.size()) {
      ramp[i] = t;
    }
    if (i < huge.size()) {
      huge[i] = 1e100 * random.normal();
    }
    sine[i] = std::sin(0.01 * t);
  }
  for (std::size_t n = 8; n < 20; ++n) {
    auto& shortest = series.emplace_back(n);
    for (double& value : shortest) {
      value = random.normal();
    }
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    const auto result = characterise_channel({.values = series[i], .dt_s = kDt});
    ASSERT_TRUE(result.has_value()) << i << ": " << result.error().message;
    EXPECT_TRUE(finite(*result)) << "series " << i;
  }
}

TEST(Characterise, ShortRecordLeavesOutTheLargestModelsWithAWarning) {
  const auto x = make(model_of({{"white_noise", {1.0}}}), 16, 1);  // four scales
  const auto result = characterise_channel({.values = x, .dt_s = kDt});
  EXPECT_EQ(result->fits.size(), 4U);  // WN, WN+GM (3), WN+GM+RW and WN+GM+DR (4)
  EXPECT_THAT(result->warnings, testing::Contains(testing::HasSubstr("WN+2GM+RW+DR")));
}

TEST(Characterise, GrossErrorsAreFittedAround) {
  const auto good = make(model_of({{"white_noise", {0.02}}, {"random_walk", {0.01}}}), 1 << 14, 21);
  auto x = good;
  Random random(22);
  for (double& value : x) {
    value += random.uniform() < 0.01 ? 20.0 * random.normal() : 0.0;  // 100 sd of the white noise
  }
  const CharacteriseOptions options{.models = {"WN", "WN+RW", "WN+GM+RW"}};
  const auto clean = characterise_channel({.values = good, .dt_s = kDt}, options);
  const auto found = characterise_channel({.values = x, .dt_s = kDt}, options);
  ASSERT_TRUE(clean && found);
  EXPECT_FALSE(clean->fits.at(0).robust);
  EXPECT_EQ(clean->contamination.verdict, "clean");
  EXPECT_EQ(found->contamination.verdict, "contaminated");
  EXPECT_TRUE(found->haar.robust_sample_wise);
  // Errors of 100 sd: some 3 % of them are within three sd and cannot be told.
  EXPECT_NEAR(static_cast<double>(found->contamination.flagged_samples), 0.01 * 16384, 45.0);
  const ModelFit& best = found->fits.at(0);
  EXPECT_TRUE(best.robust);
  EXPECT_EQ(best.model, clean->fits.at(0).model);
  ASSERT_TRUE(parameter(best, 0, 0).estimate && parameter(best, 1, 0).estimate);
  // Relative standard error of N some 0.8 %, of K some 10 %, on either record.
  EXPECT_NEAR(parameter(best, 0, 0).estimate->value, 0.02, 0.02 * 0.04);
  EXPECT_NEAR(parameter(best, 1, 0).estimate->value, parameter(clean->fits.at(0), 1, 0).estimate->value, 0.002);
  for (std::size_t j = 0; j < found->haar.robust_variance.size(); ++j) {
    EXPECT_TRUE(found->haar.robust_variance[j].has_value());
    EXPECT_GT(found->haar.robust_efficiency[j], 0.5);
    EXPECT_LT(found->haar.robust_efficiency[j], 1.0 + 1e-12);
  }
}

TEST(Characterise, ErrorsWithinASecondAreOneBurst) {
  auto x = make(model_of({{"white_noise", {0.02}}}), 1 << 14, 31);
  const auto second = static_cast<std::size_t>(std::lround(1.0 / kDt));
  for (std::size_t burst = 0; burst < 12; ++burst) {
    for (std::size_t i = 0; i < 5; ++i) {  // the five within half a second, the next burst more than two later
      x[second * (4 + 3 * burst) + i * (second / 10)] += i % 2 == 0 ? 5.0 : -5.0;
    }
  }
  const auto found = characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN"}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->contamination.flagged_samples, 60U);
  EXPECT_EQ(found->contamination.bursts, 12U);
}

TEST(Characterise, MissingSamplesAreNeitherBridgedNorCutAway) {
  const auto good = make(model_of({{"white_noise", {0.02}}, {"random_walk", {0.01}}}), 1 << 14, 23);
  std::vector<double> rows;
  std::vector<Gap> gaps;
  std::size_t missing = 0;
  for (std::size_t t = 0; t < good.size(); ++t) {
    if (t % 1000 >= 950 && t > 0) {
      ++missing;
      if (!gaps.empty() && gaps.back().row == rows.size()) {
        ++gaps.back().missing;
      } else {
        gaps.push_back({rows.size(), 1});
      }
    } else {
      rows.push_back(good[t]);
    }
  }
  const CharacteriseOptions options{.models = {"WN+RW"}};
  const auto whole = characterise_channel({.values = good, .dt_s = kDt}, options);
  const auto gappy = characterise_channel({.values = rows, .dt_s = kDt, .gaps = gaps}, options);
  ASSERT_TRUE(whole && gappy);
  EXPECT_EQ(gappy->samples, rows.size());
  EXPECT_EQ(gappy->missing, missing);
  EXPECT_EQ(gappy->haar.scale, whole->haar.scale);
  EXPECT_EQ(gappy->contamination.verdict, "clean");
  for (std::size_t j = 0; j < 10; ++j) {
    EXPECT_NEAR(gappy->haar.variance[j] / whole->haar.variance[j], 1.0,
                0.02 + 2.0 * std::sqrt(0.1 * 2.0 / whole->haar.edf[j]))
        << j;
    EXPECT_LE(gappy->haar.edf[j], 1.05 * whole->haar.edf[j]);
  }
  EXPECT_NEAR(parameter(gappy->fits.at(0), 0, 0).estimate->value, 0.02, 0.02 * 0.03);
  const std::vector<Gap> outside{{rows.size() + 5, 1}};
  EXPECT_EQ(characterise_channel({.values = rows, .dt_s = kDt, .gaps = outside}, options).error().code,
            ErrorCode::InvalidArgument);
}

/// A sensor that froze for most of a recording with gaps: what is missing cannot be completed, what is sound still
/// counts.
TEST(Characterise, AFrozenSensorWithGapsIsAnalysedBetweenThem) {
  std::vector<double> rows = make(model_of({{"white_noise", {0.02}}}), 6000, 29);
  std::fill(rows.begin() + 900, rows.end(), rows[899]);
  const std::vector<Gap> gaps{{950, 2}, {5000, 1}};
  const auto found = characterise_channel({.values = rows, .dt_s = kDt, .gaps = gaps}, {.models = {"WN"}});
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_FALSE(found->warnings.empty());
  EXPECT_NE(found->warnings.back().find("4050 of 6000 samples"), std::string::npos) << found->warnings.back();
}

TEST(Characterise, OptionsAreCheckedWithoutData) {
  EXPECT_TRUE(check_options({}).has_value());
  EXPECT_FALSE(check_options({.models = {}}).has_value());
  for (const char* name : {"", "XX", "WN+", "WN+WN", "wn", "2WN", "WN+9GM", "WN GM"}) {
    const auto status = check_options({.models = {name}});
    ASSERT_FALSE(status.has_value()) << name;
    EXPECT_EQ(status.error().code, ErrorCode::InvalidArgument);
    EXPECT_THAT(status.error().fields, testing::Contains(ErrorField{"parameter", "models"}));
  }
}

TEST(Characterise, ReportsRisingProgressAndStopsWhenAsked) {
  const auto x = make(model_of({{"white_noise", {1.0}}}), 5000, 1);
  double last = -1.0;
  bool rising = true;
  RunControl control;
  control.progress = [&](std::string_view /*stage*/, double fraction) {
    rising = rising && fraction >= last && fraction <= 1.0;
    last = fraction;
  };
  ASSERT_TRUE(characterise_channel({.values = x, .dt_s = kDt}, {}, control).has_value());
  EXPECT_TRUE(rising);
  EXPECT_EQ(last, 1.0);
  std::stop_source source;
  source.request_stop();
  control.stop = source.get_token();
  const auto stopped = characterise_channel({.values = x, .dt_s = kDt}, {}, control);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace driftlab
