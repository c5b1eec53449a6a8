#include "core/fit/completion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab {
namespace {

constexpr double kLevel = 9.0;

/// Covariance of the samples of a model whose level starts with variance kLevel.
Eigen::MatrixXd covariance_of(const LinearStates& states, int samples) {
  Eigen::MatrixXd covariance(samples, samples);
  for (int s = 0; s < samples; ++s) {
    for (int t = 0; t < samples; ++t) {
      double sum = kLevel + states.noise[0] * std::min(s, t);
      for (int k = 1; k < states.count - (states.quantization ? 1 : 0); ++k) {
        const auto at = static_cast<std::size_t>(k);
        sum += states.start[at] * std::pow(states.transition[at], std::abs(s - t));
      }
      const int lag = std::abs(s - t);
      sum += lag == 0 ? states.white + 2.0 * states.error : (lag == 1 ? -states.error : 0.0);
      covariance(s, t) = sum;
    }
  }
  return covariance;
}

Model composite() {
  return {*make_process("quantization_noise", {0.7}), *make_process("white_noise", {0.4}),
          *make_process("gauss_markov", {0.8, 0.2}), *make_process("random_walk", {0.3})};
}

TEST(LinearStates, LeaveOneOutVarianceIsTheInverseOfTheMeanInverseDensity) {
  // White noise N = 2: 4. Random walk and white noise of equal variance: mean of 1/(1 + 1/(4 s^2)) over f is
  // 1 - 1/sqrt(5) (residues), hence V = 1/(1 - 1/sqrt 5).
  const auto white = linear_states({*make_process("white_noise", {2.0})}, 1.0, 1.0);
  ASSERT_TRUE(white.has_value());
  EXPECT_NEAR(white->leave_one_out_variance(), 4.0, 1e-9);
  const auto walk = linear_states({*make_process("white_noise", {1.0}), *make_process("random_walk", {1.0})}, 1.0, 1.0);
  ASSERT_TRUE(walk.has_value());
  EXPECT_NEAR(walk->leave_one_out_variance(), 1.0 / (1.0 - 1.0 / std::sqrt(5.0)), 1e-4);
  EXPECT_FALSE(linear_states({*make_process("flicker_noise", {1.0})}, 1.0, 1.0).has_value());
  EXPECT_FALSE(linear_states({*make_process("linear_drift", {1.0})}, 1.0, 1.0).has_value());
}

TEST(Completion, AbsentSamplesFollowTheirExactConditionalLaw) {
  // 30 samples, six absent (the first, a run, the last): the conditional mean and covariance of a dense Gaussian
  // against 20,000 draws.
  constexpr int kSamples = 30;
  constexpr int kDraws = 20000;
  for (const bool quantized : {true, false}) {
    Model model = composite();
    if (!quantized) {
      model.erase(model.begin());
    }
    const auto states = linear_states(model, 1.0, kLevel);
    ASSERT_TRUE(states.has_value());
    const Eigen::MatrixXd all = covariance_of(*states, kSamples);
    const std::vector<int> absent{0, 11, 12, 13, 20, 29};
    std::vector<int> present;
    std::vector<std::uint8_t> state(kSamples, kGoodSample);
    for (const int t : absent) {
      state[static_cast<std::size_t>(t)] = kAbsentSample;
    }
    std::vector<double> recorded(kSamples);
    for (int t = 0; t < kSamples; ++t) {
      recorded[static_cast<std::size_t>(t)] = std::sin(0.7 * t) + 0.05 * t;
      if (state[static_cast<std::size_t>(t)] == kGoodSample) {
        present.push_back(t);
      }
    }
    Eigen::VectorXd y(static_cast<Eigen::Index>(present.size()));
    for (std::size_t i = 0; i < present.size(); ++i) {
      y(static_cast<Eigen::Index>(i)) = recorded[static_cast<std::size_t>(present[i])];
    }
    const Eigen::MatrixXd cross = all(absent, present);
    const Eigen::LLT<Eigen::MatrixXd> factor(all(present, present));
    const Eigen::VectorXd mean = cross * factor.solve(y);
    const Eigen::MatrixXd covariance = all(absent, absent) - cross * factor.solve(cross.transpose());

    CompletionLaw law;
    law.states = *states;
    ResidualHistogram histogram;
    Random random(3);
    std::vector<double> completed(kSamples);
    const auto count = static_cast<Eigen::Index>(absent.size());
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(count);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(count, count);
    for (int draw = 0; draw < kDraws; ++draw) {
      sweep_completion(law, {recorded, state, completed, {}}, random, histogram);
      Eigen::VectorXd drawn(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        drawn(i) = completed[static_cast<std::size_t>(absent[static_cast<std::size_t>(i)])] - mean(i);
      }
      sum += drawn;
      square += drawn * drawn.transpose();
    }
    for (Eigen::Index i = 0; i < count; ++i) {
      const double sd = std::sqrt(covariance(i, i));
      EXPECT_NEAR(sum(i) / kDraws, 0.0, 5.0 * sd / std::sqrt(kDraws)) << i << quantized;
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double scale = sd * std::sqrt(covariance(j, j));
        EXPECT_NEAR(square(i, j) / kDraws, covariance(i, j), 5.0 * scale * std::sqrt(2.0 / kDraws))
            << i << ' ' << j << quantized;
      }
    }
    EXPECT_EQ(completed[5], recorded[5]);
  }
}

TEST(Completion, ResidualsOfTheTrueModelAreStandardNormal) {
  const auto states = linear_states(composite(), 1.0, kLevel);
  ASSERT_TRUE(states.has_value());
  Random random(5);
  constexpr std::size_t kSamples = 20000;  // ten blocks
  const std::vector<double> x = simulate(composite(), random, 1.0, kSamples);
  std::vector<std::uint8_t> state(kSamples, kGoodSample);
  std::vector<double> completed(kSamples);
  std::vector<float> residual(kSamples);
  ResidualHistogram histogram;
  CompletionLaw law;
  law.states = *states;
  law.unit = states->leave_one_out_variance();
  sweep_completion(law, {x, state, completed, residual}, random, histogram);
  double square = 0.0;
  for (const float z : residual) {
    square += static_cast<double>(z) * static_cast<double>(z);
  }
  // Residuals are correlated over a few samples: three times the variance of independent ones is ample.
  EXPECT_NEAR(square / kSamples, 1.0, 4.0 * std::sqrt(6.0 / kSamples));
  EXPECT_EQ(histogram.total(), kSamples);
  EXPECT_EQ(completed, x);
}

TEST(Completion, ResidualsOfLongRunsAreThoseOfTheWholeCovariance) {
  // In a run of good samples the backward precision settles, and is then no longer computed: every residual must still
  // be the one that the inverse of the covariance gives, r_t = (C^-1 y)_t/sqrt((C^-1)_tt), where runs and a gap follow.
  constexpr int kSamples = 700;
  for (const bool quantized : {true, false}) {
    Model model = composite();
    if (!quantized) {
      model.erase(model.begin());
    }
    const auto states = linear_states(model, 1.0, kLevel);
    ASSERT_TRUE(states.has_value());
    Random random(8);
    const std::vector<double> x = simulate(model, random, 1.0, kSamples);
    std::vector<std::uint8_t> state(kSamples, kGoodSample);
    std::vector<int> present;
    for (int t = 0; t < kSamples; ++t) {
      state[static_cast<std::size_t>(t)] = t >= 300 && t < 304 ? kAbsentSample : kGoodSample;
      if (t < 300 || t >= 304) {
        present.push_back(t);
      }
    }
    const Eigen::MatrixXd all = covariance_of(*states, kSamples);
    const Eigen::MatrixXd inverse = all(present, present).inverse();
    Eigen::VectorXd y(static_cast<Eigen::Index>(present.size()));
    for (std::size_t i = 0; i < present.size(); ++i) {
      y(static_cast<Eigen::Index>(i)) = x[static_cast<std::size_t>(present[i])];
    }
    const Eigen::VectorXd whole = inverse * y;
    // After the gap residuals hang on what was drawn inside it.
    CompletionLaw law;
    law.states = *states;
    ResidualHistogram histogram;
    std::vector<double> completed(kSamples);
    std::vector<float> residual(kSamples);
    sweep_completion(law, {x, state, completed, residual}, random, histogram);
    for (std::size_t i = 0; i < present.size(); ++i) {
      if (present[i] >= 304) {
        break;
      }
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(static_cast<double>(residual[static_cast<std::size_t>(present[i])]),
                  std::fabs(whole(at)) / std::sqrt(inverse(at, at)), 2e-5)
          << present[i] << quantized;
    }
  }
}

TEST(OutlierMixture, FindsCoreAndShareOfAMixture) {
  // 5 % of residuals carry an error of 6 standard deviations.
  Random random(9);
  ResidualHistogram histogram;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double z = random.normal() + (random.uniform() < 0.05 ? 6.0 * random.normal() : 0.0);
    histogram.add(std::fabs(z));
  }
  OutlierMixture mixture = OutlierMixture::up_to(histogram.largest());
  mixture.refine(histogram, 400);
  EXPECT_NEAR(mixture.outlier_share(), 0.05, 0.006);
  EXPECT_NEAR(mixture.core, 1.0, 0.02);
  EXPECT_LT(mixture.posterior(0.5), 0.02);
  EXPECT_GT(mixture.posterior(6.0), 0.99);
  EXPECT_EQ(mixture.posterior(1e150), 1.0);
}

TEST(OutlierMixture, NormalResidualsCarryNoErrors) {
  Random random(10);
  ResidualHistogram histogram;
  for (int i = 0; i < 100000; ++i) {
    histogram.add(std::fabs(random.normal()));
  }
  OutlierMixture mixture = OutlierMixture::up_to(histogram.largest());
  mixture.refine(histogram, 400);
  EXPECT_LT(mixture.outlier_share(), 0.002);
  EXPECT_NEAR(mixture.core, 1.0, 0.02);
  EXPECT_TRUE(std::isinf(false_discovery_limit(histogram, 1.0, 0.01)));
}

TEST(OutlierMixture, BinsCoverEveryMagnitude) {
  for (const double z : {0.0, 0.01, 7.999, 8.0, 8.1, 100.0, 1e6, 1e100, 1e308}) {
    const std::size_t bin = ResidualHistogram::bin_of(z);
    ASSERT_LT(bin, ResidualHistogram::kBins);
    EXPECT_LE(ResidualHistogram::lower_end(bin), z * (1.0 + 1e-12));
  }
}

}  // namespace
}  // namespace driftlab
