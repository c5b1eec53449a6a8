#include "core/investigate/slow/slow_fit.hpp"
#include "core/process/flicker_noise.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

BlockSeries series_of(std::size_t recordings, std::size_t blocks, std::size_t block, double dt_s) {
  BlockSeries series;
  series.dt_s = dt_s;
  series.block = block;
  for (std::size_t r = 0; r < recordings; ++r) {
    BlockRecording recording;
    recording.mean.assign(blocks, 0.0);
    recording.filled.assign(blocks, 1.0);
    series.recordings.push_back(recording);
  }
  return series;
}

/// Covariance of block means of point samples, from the autocovariance of the samples.
Eigen::MatrixXd block_covariance(const SlowModel& model, std::size_t blocks, std::size_t block, double dt_s) {
  const std::size_t n = blocks * block;
  Eigen::MatrixXd fine = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double lag = dt_s * std::fabs(static_cast<double>(i) - static_cast<double>(j));
      double c = i == j ? model.white / dt_s : 0.0;
      for (const SlowComponent& component : model.components) {
        if (component.process.kind == &registered<GaussMarkov>()) {
          c += component.process.square() * std::exp(-component.process.only_shape() * lag);
        } else if (component.process.kind == &registered<RandomWalk>()) {
          c += component.process.square() * dt_s * static_cast<double>(std::min(i, j) + 1);
        }
      }
      fine(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = c;
    }
  }
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(blocks), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    mean(static_cast<Eigen::Index>(i / block), static_cast<Eigen::Index>(i)) = 1.0 / static_cast<double>(block);
  }
  return mean * fine * mean.transpose();
}

double dense_log_likelihood(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& y) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd l = factor.matrixL();
  return -l.diagonal().array().log().sum() - 0.5 * y.dot(factor.solve(y));
}

TEST(SlowModel, WhiteningOfBlockMeansIsExactForGaussMarkovProcesses) {
  SlowModel model;
  model.white = 0.02;
  model.components = {slow_component(registered<GaussMarkov>(), 1.0, 0.7),
                      slow_component(registered<GaussMarkov>(), 0.5, 0.05)};
  for (const std::size_t block : {std::size_t{1}, std::size_t{4}}) {
    BlockSeries series = series_of(1, 60, block, 0.05);
    BlockColumns columns = BlockColumns::zeros(series, 1);
    Eigen::VectorXd y(60);
    Random random(1);
    for (std::size_t b = 0; b < 60; ++b) {
      columns.rows[0][b] = y[static_cast<Eigen::Index>(b)] = random.normal();
    }
    const double exact = dense_log_likelihood(block_covariance(model, 60, block, 0.05), y);
    const double filtered = evaluate_slow(series, columns, model).log_likelihood;
    EXPECT_NEAR(filtered, exact, 1e-6 * std::fabs(exact)) << "block " << block;
  }
}

TEST(SlowModel, WhiteningOfARandomWalkIsExactAtSingleSamplesAndCloseInBlocks) {
  SlowModel model;
  model.white = 0.05;
  model.components = {slow_component(registered<RandomWalk>(), 0.3)};
  for (const std::size_t block : {std::size_t{1}, std::size_t{4}}) {
    BlockSeries series = series_of(1, 60, block, 0.05);
    BlockColumns columns = BlockColumns::zeros(series, 1);
    Eigen::VectorXd y(60);
    Random random(2);
    for (std::size_t b = 0; b < 60; ++b) {
      columns.rows[0][b] = y[static_cast<Eigen::Index>(b)] = random.normal();
    }
    const double exact = dense_log_likelihood(block_covariance(model, 60, block, 0.05), y);
    // The first block alone is approximate: the walk's start is spread over half a block.
    EXPECT_NEAR(evaluate_slow(series, columns, model).log_likelihood, exact, 0.05) << "block " << block;
  }
}

TEST(SlowModel, TransposedFilterIsTheAdjoint) {
  SlowModel model;
  model.white = 0.02;
  model.components = {slow_component(registered<GaussMarkov>(), 1.0, 0.3),
                      slow_component(registered<RandomWalk>(), 0.01)};
  BlockSeries series = series_of(1, 200, 2, 0.1);
  series.recordings[0].filled[50] = 0.0;
  BlockColumns columns = BlockColumns::zeros(series, 1);
  std::vector<double> other(200);
  Random random(3);
  for (std::size_t b = 0; b < 200; ++b) {
    columns.rows[0][b] = random.normal();
    other[b] = random.normal();
  }
  const Whitened whitened = whiten(series, model, columns);
  const std::vector<double> back = whiten_transposed(series, model, 0, other);
  double left = 0.0;
  double right = 0.0;
  for (std::size_t b = 0; b < 200; ++b) {
    left += whitened.columns.rows[0][b] * other[b];
    right += columns.rows[0][b] * back[b];
  }
  EXPECT_NEAR(left, right, 1e-9 * std::fabs(left) + 1e-12);
}

TEST(SlowFit, RecoversAGaussMarkovProcessAndADriftWithinTheirIntervals) {
  BlockSeries series = series_of(3, 3000, 1, 0.2);
  BlockColumns columns = BlockColumns::zeros(series, 3);
  Random random(4);
  const double phi = std::exp(-0.1 * 0.2);
  for (std::size_t r = 0; r < 3; ++r) {
    double x = 0.1 * random.normal();
    for (std::size_t b = 0; b < 3000; ++b) {
      columns.rows[r][3 * b] = x + 0.3 * random.normal() + 0.5 + 1e-3 * 0.2 * static_cast<double>(b);
      columns.rows[r][3 * b + 1] = 1.0;
      columns.rows[r][3 * b + 2] = 0.2 * static_cast<double>(b);
      x = phi * x + 0.1 * std::sqrt(1.0 - phi * phi) * random.normal();
    }
  }
  SlowModel start;
  start.white = 0.01;
  start.components = {slow_component(registered<GaussMarkov>(), 0.003, 0.5)};
  const SlowFit fit = fit_slow(series, columns, start);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.model.white / 0.2, 0.09, 4.0 * 0.09 * std::sqrt(2.0 / 9000.0));
  EXPECT_TRUE(profile_amplitude(series, columns, fit, 2, {}).contains(1e-3));
  EXPECT_TRUE(profile_parameter(series, columns, fit, {0, false}, {}).contains(0.01));
  EXPECT_TRUE(profile_parameter(series, columns, fit, {0, true}, {}).contains(0.1));
}

/// Flicker noise of more power than the white noise beside it was given half its level, and the rest to processes that
/// are not there: the fastest of the six that stand for it, gone within a block, had a negative white remainder of many
/// times its variance. At density ratios B^2/N^2 below and above one the fit has to return the level.
TEST(SlowFit, FlickerNoiseAboveTheWhiteKeepsItsLevel) {
  constexpr std::size_t kBlock = 10;
  constexpr std::size_t kBlocks = 3000;
  constexpr double kDt = 0.02;
  for (const double ratio : {0.3, 2.5, 10.0}) {
    BlockSeries series = series_of(3, kBlocks, kBlock, kDt);
    BlockColumns columns = BlockColumns::zeros(series, 2);
    Random random(6);
    FlickerNoise flicker;
    flicker.b = std::sqrt(ratio);
    for (std::size_t r = 0; r < 3; ++r) {
      std::vector<double> samples(kBlock * kBlocks, 0.0);
      flicker.add_path(random, kDt, samples);
      for (std::size_t b = 0; b < kBlocks; ++b) {
        for (std::size_t i = 0; i < kBlock; ++i) {
          columns.rows[r][2 * b] +=
              (samples[b * kBlock + i] + random.normal() / std::sqrt(kDt)) / static_cast<double>(kBlock);
        }
        columns.rows[r][2 * b + 1] = 1.0;
      }
    }
    SlowModel start;
    start.white = 1.0;
    start.components = {slow_component(registered<FlickerNoise>(), 0.1 * ratio)};
    const SlowFit fit = fit_slow(series, columns, start, {.white = false});
    ASSERT_TRUE(fit.converged);
    // Five standard deviations, and 10 % for the density of six processes near the block's Nyquist frequency.
    const double sd = 1.0 / std::sqrt(fit.information(0, 0));
    EXPECT_NEAR(std::log(fit.model.components[0].process.square() / ratio), 0.0, 5.0 * sd + 0.1) << ratio;
  }
}

TEST(SlowModel, AsManyProcessesAsABaselineNamesAreWhitened) {
  // Twenty equal Gauss-Markov processes are one of their common level.
  SlowModel many;
  SlowModel one;
  many.white = one.white = 0.02;
  one.components = {slow_component(registered<GaussMarkov>(), 2.0, 0.3)};
  many.components.assign(20, slow_component(registered<GaussMarkov>(), 0.1, 0.3));
  BlockSeries series = series_of(1, 200, 4, 0.05);
  BlockColumns columns = BlockColumns::zeros(series, 1);
  Random random(3);
  for (double& v : columns.rows[0]) {
    v = random.normal();
  }
  EXPECT_NEAR(evaluate_slow(series, columns, many).log_likelihood, evaluate_slow(series, columns, one).log_likelihood,
              1e-6);
}

}  // namespace
}  // namespace driftlab::investigate
