/// A telegraph and a Gauss-Markov process of one spectrum: the likelihood of two levels tells them apart.
#include "core/investigate/slow/telegraph.hpp"

#include "core/investigate/slow/slow_fit.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random.hpp"
#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kAmplitude = 1.2;
constexpr double kDwell = 30.0;  // [s], blocks of one second

/// Two records of 1500 blocks of white noise of unit variance, and the given slow part.
template <class Slow>
BlockSeries series_with(std::uint64_t seed, Slow slow) {
  BlockSeries series;
  series.dt_s = 1.0;
  series.block = 1;
  Random random(seed, 1);
  for (std::size_t r = 0; r < 2; ++r) {
    BlockRecording recording;
    slow.begin(random);
    for (int b = 0; b < 1500; ++b) {
      recording.mean.push_back(random.normal() + slow.next(random));
      recording.filled.push_back(1.0);
    }
    series.recordings.push_back(std::move(recording));
  }
  return series;
}

struct Jumps {
  double side = kAmplitude;
  void begin(Random& random) { side = random.uniform() < 0.5 ? kAmplitude : -kAmplitude; }
  double next(Random& random) {
    side = random.uniform() < 1.0 - std::exp(-1.0 / kDwell) ? -side : side;
    return side;
  }
};

struct SameSpectrum {
  double x = 0.0;
  double phi = std::exp(-2.0 / kDwell);
  void begin(Random& random) { x = kAmplitude * random.normal(); }
  double next(Random& random) {
    x = phi * x + kAmplitude * std::sqrt(1.0 - phi * phi) * random.normal();
    return x;
  }
};

SlowModel white() {
  SlowModel model;
  model.white = 1.0;
  return model;
}

/// Twice the log likelihood ratio of the best telegraph to the best Gauss-Markov process.
double telegraph_over_gauss_markov(const BlockSeries& series) {
  BlockColumns columns = BlockColumns::zeros(series, 2);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
      columns.rows[r][2 * b] = series.recordings[r].mean[b];
      columns.rows[r][2 * b + 1] = 1.0;
    }
  }
  SlowModel slow = white();
  slow.components.push_back(slow_component(registered<GaussMarkov>(), 1.0, 0.1));
  return 2.0 * (fit_telegraph(series, white()).log_likelihood - fit_slow(series, columns, slow).log_likelihood);
}

TEST(Telegraph, IsEstimatedWithItsDeviations) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TelegraphFit fit = fit_telegraph(series_with(seed, Jumps{}), white());
    EXPECT_NEAR(std::log(fit.telegraph.amplitude / kAmplitude), 0.0, 4.0 * fit.log_amplitude_sd + 0.01) << seed;
    EXPECT_NEAR(std::log(fit.telegraph.dwell_s / kDwell), 0.0, 4.0 * fit.log_dwell_sd + 0.02) << seed;
    EXPECT_LT(fit.log_amplitude_sd, 0.1);
    // Of 100 changes the mean time between them is known to a tenth at best.
    EXPECT_GT(fit.log_dwell_sd, 0.07);
    EXPECT_LT(fit.log_dwell_sd, 0.2);
  }
}

/// Beside a slow process too, with holes: a telegraph of no amplitude is the model alone.
TEST(Telegraph, OfNoAmplitudeIsTheModel) {
  BlockSeries series = series_with(31, SameSpectrum{});
  series.recordings[1].filled[7] = 0.0;
  series.recordings[1].filled[8] = 0.5;
  SlowModel slow = white();
  slow.components.push_back(slow_component(registered<GaussMarkov>(), kAmplitude * kAmplitude, 2.0 / kDwell));
  BlockColumns columns = BlockColumns::zeros(series, 1);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    series.recordings[r].pattern = r;
    for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
      columns.rows[r][b] = series.recordings[r].filled[b] > 0.0 ? series.recordings[r].mean[b] : 0.0;
    }
  }
  EXPECT_NEAR(telegraph_log_likelihood(series, slow, {0.0, kDwell, 0.0}),
              evaluate_slow(series, columns, slow).log_likelihood, 1e-6);
}

TEST(Telegraph, IsToldFromAGaussMarkovProcessOfItsSpectrum) {
  for (std::uint64_t seed = 11; seed <= 14; ++seed) {
    EXPECT_GT(telegraph_over_gauss_markov(series_with(seed, Jumps{})), 25.0) << seed;
    EXPECT_LT(telegraph_over_gauss_markov(series_with(seed, SameSpectrum{})), 0.0) << seed;
  }
}

TEST(Telegraph, SidesAreThoseThatWereDrawn) {
  BlockSeries series = series_with(21, Jumps{});
  const std::vector<double> side = telegraph_sides(series, white(), {kAmplitude, kDwell, 0.0}, 0);
  // Over ten blocks about a place the mean stands 1.2 sqrt(10) deviations from 0: the sign of a running mean is the
  // side except about the changes.
  double agree = 0.0;
  double counted = 0.0;
  const std::vector<double>& mean = series.recordings[0].mean;
  for (std::size_t b = 5; b + 5 < mean.size(); ++b) {
    double sum = 0.0;
    for (std::size_t k = b - 5; k <= b + 5; ++k) {
      sum += mean[k] / 11.0;
    }
    if (std::fabs(sum) > 0.9 && std::fabs(side[b]) > 0.9) {
      counted += 1.0;
      agree += sum * side[b] > 0.0 ? 1.0 : 0.0;
    }
  }
  EXPECT_GT(counted, 600.0);
  EXPECT_GT(agree / counted, 0.98);
}

}  // namespace
}  // namespace driftlab::investigate
