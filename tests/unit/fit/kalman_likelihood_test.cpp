#include "tests/likelihood/kalman_likelihood.hpp"

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stop_token>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

Model model_of(std::initializer_list<std::pair<const char*, std::vector<double>>> parts) {
  Model model;
  for (const auto& [name, values] : parts) {
    model.push_back(*make_process(name, values));
  }
  return model;
}

std::vector<double> series(const Model& model, std::size_t samples, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> x = simulate(model, random, kDt, samples);
  for (double& value : x) {
    value += 3.0;
  }
  return x;
}

/// The definition: a multivariate normal with the processes' covariance, constant (and slope) by generalised least
/// squares.
double by_definition(const std::vector<double>& samples, const Model& model) {
  std::vector<double> times;
  std::vector<double> present;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (!std::isnan(samples[t])) {
      times.push_back(static_cast<double>(t));
      present.push_back(samples[t]);
    }
  }
  const auto n = static_cast<Eigen::Index>(present.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  bool drifts = false;
  for (const Process& process : model) {
    drifts = drifts || process.kind->symbol == "DR";
    if (process.kind->symbol == "DR") {
      continue;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const double a = times[static_cast<std::size_t>(i)];
        const double b = times[static_cast<std::size_t>(j)];
        const auto stationary = process.autocovariance(a - b, kDt);
        // A walk that starts at 0: variance of the shorter time.
        covariance(i, j) += stationary ? *stationary : process.variogram(std::min(a, b), kDt);
      }
    }
  }
  Eigen::MatrixXd columns(n, drifts ? 2 : 1);
  columns.col(0).setOnes();
  if (drifts) {
    columns.col(1) = Eigen::Map<const Eigen::VectorXd>(times.data(), n) * kDt;
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd y = factor.matrixL().solve(Eigen::Map<const Eigen::VectorXd>(present.data(), n));
  const Eigen::MatrixXd x = factor.matrixL().solve(columns);
  const Eigen::VectorXd residual = y - x * (x.transpose() * x).ldlt().solve(x.transpose() * y);
  const double log_det = 2.0 * Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  return -0.5 * (static_cast<double>(n) * std::log(2.0 * std::numbers::pi) + log_det + residual.squaredNorm());
}

TEST(KalmanLikelihood, EqualsTheMultivariateNormalItStandsFor) {
  // 300 samples: the gain has long settled. Both sides add some 10^3 terms of order 1 to 10^3: 1e-7 is rounding.
  const std::vector<Model> models{
      model_of({{"white_noise", {0.02}}}),
      model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.5, 2.0}}}),
      model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.5, 20.0}}, {"gauss_markov", {0.2, 0.3}}}),
      model_of({{"quantization_noise", {0.001}}, {"white_noise", {0.01}}, {"random_walk", {0.3}}}),
      model_of({{"quantization_noise", {0.001}}, {"gauss_markov", {0.1, 1.0}}}),
      model_of({{"white_noise", {0.02}}, {"random_walk", {0.1}}, {"linear_drift", {0.5}}}),
      model_of({{"white_noise", {0.02}}, {"sinusoid", {0.4, 3.0}}}),
  };
  for (std::size_t i = 0; i < models.size(); ++i) {
    std::vector<double> x = series(models[i], 300, 40 + i);
    for (const bool gaps : {false, true}) {
      if (gaps) {
        for (const std::size_t t : {0U, 7U, 150U, 151U, 152U, 200U, 299U}) {
          x[t] = kMissing;
        }
      }
      const auto found = kalman_likelihood(x, models[i], kDt);
      ASSERT_TRUE(found.has_value()) << i;
      EXPECT_EQ(found->samples, gaps ? 293U : 300U);
      EXPECT_EQ(found->relative_error, 0.0);
      EXPECT_NEAR(found->log_likelihood, by_definition(x, models[i]), 1e-7) << "model " << i << " gaps " << gaps;
    }
  }
}

TEST(KalmanLikelihood, ScaledIsTheBestOverOneCommonFactor) {
  const Model model = model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.5, 2.0}}});
  const std::vector<double> x = series(model, 3000, 5);
  Model wrong = model;
  for (Process& process : wrong) {
    process.parameters[0] *= 3.0;
  }
  const auto at_wrong = kalman_likelihood(x, wrong, kDt);
  const auto at_right = kalman_likelihood(x, model, kDt);
  EXPECT_NEAR(at_wrong->scaled_log_likelihood, at_right->scaled_log_likelihood, 1e-7);
  EXPECT_NEAR(at_wrong->scale, at_right->scale / 9.0, 1e-9);
  EXPECT_GE(at_right->scaled_log_likelihood, at_right->log_likelihood);
}

TEST(KalmanLikelihood, FindsMeanAndSlopeWithHonestErrors) {
  // 200 runs: the standardised errors have mean 0 and mean square 1, within 4.5 standard errors (sqrt(2/200) = 0.1).
  const Model model = model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.5, 2.0}}, {"linear_drift", {0.01}}});
  double mean_square = 0.0;
  double slope_square = 0.0;
  for (std::uint64_t run = 0; run < 200; ++run) {
    const std::vector<double> x = series(model, 4000, 100 + run);
    const auto found = kalman_likelihood(x, model, kDt);
    ASSERT_TRUE(found.has_value());
    const double middle = 3.0 + 0.01 * 0.5 * 3999 * kDt;
    mean_square += std::pow((found->mean - middle) / found->mean_sd, 2.0) / 200.0;
    slope_square += std::pow((found->slope - 0.01) / found->slope_sd, 2.0) / 200.0;
  }
  EXPECT_NEAR(mean_square, 1.0, 0.45);
  EXPECT_NEAR(slope_square, 1.0, 0.45);
}

TEST(KalmanLikelihood, FlickerNoiseComesWithItsError) {
  const Model model = model_of({{"white_noise", {0.02}}, {"flicker_noise", {0.05}}});
  const auto found = kalman_likelihood(series(model, 3000, 8), model, kDt);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(found->relative_error, 0.0);
  EXPECT_LT(found->relative_error, 0.2);
  EXPECT_NEAR(found->scale, 1.0, 0.12);  // 4.5 standard errors of the mean of 3,000 squares
}

TEST(KalmanLikelihood, RefusesWhatHasNone) {
  const Model white = model_of({{"white_noise", {0.02}}});
  const std::vector<double> x = series(white, 100, 1);
  EXPECT_EQ(kalman_likelihood(x, {}, kDt).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(kalman_likelihood(x, white, 0.0).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(kalman_likelihood(x, model_of({{"linear_drift", {1.0}}}), kDt).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(kalman_likelihood(std::vector<double>(9, kMissing), white, kDt).error().code, ErrorCode::TooFewSamples);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(kalman_likelihood(x, white, kDt, {.stop = source.get_token(), .progress = {}}).error().code,
            ErrorCode::Cancelled);
}

TEST(MaximiseLikelihood, RisesAboveTheTruthByWhatItsParametersBuy) {
  // 2 (ln L(best) - ln L(truth)) is chi-square(4), mean 4 with standard error sqrt(8/20) = 0.63 over 20 runs; a start
  // that is off by factors must not matter.
  const Model truth = model_of({{"white_noise", {0.02}}, {"gauss_markov", {0.5, 2.0}}, {"random_walk", {0.1}}});
  Model start = truth;
  start[0].parameters[0] *= 1.5;
  start[1].parameters[1] *= 3.0;
  start[2].parameters[0] *= 0.4;
  double gain = 0.0;
  for (std::uint64_t run = 0; run < 20; ++run) {
    const std::vector<double> x = series(truth, 2000, 700 + run);
    const auto fit = maximise_likelihood(x, start, kDt);
    ASSERT_TRUE(fit.has_value());
    const auto at_truth = kalman_likelihood(x, truth, kDt);
    EXPECT_GE(fit->likelihood.log_likelihood, at_truth->log_likelihood - 1e-3) << run;
    const auto again = kalman_likelihood(x, fit->model, kDt);
    EXPECT_NEAR(again->log_likelihood, fit->likelihood.log_likelihood, 1e-5) << "the model given is the one found";
    gain += 2.0 * (fit->likelihood.log_likelihood - at_truth->log_likelihood) / 20.0;
  }
  EXPECT_NEAR(gain, 4.0, 4.5 * 0.63);
}

TEST(MaximiseLikelihood, WhiteNoiseIsItsSampleVariance) {
  const Model truth = model_of({{"white_noise", {0.02}}});
  const std::vector<double> x = series(truth, 1000, 3);
  double mean = 0.0;
  for (const double value : x) {
    mean += value / 1000.0;
  }
  double square = 0.0;
  for (const double value : x) {
    square += (value - mean) * (value - mean) / 1000.0;
  }
  const auto fit = maximise_likelihood(x, truth, kDt);
  EXPECT_NEAR(fit->model[0].parameters[0], std::sqrt(square * kDt), 1e-12);
  EXPECT_NEAR(fit->likelihood.mean, mean, 1e-12);
  EXPECT_TRUE(fit->converged);
}

}  // namespace
}  // namespace driftlab
