/// What the choice of a step's time is worth: the search's false alarms against those of a single look.
#include "core/investigate/slow/step_scan.hpp"

#include "core/process/gauss_markov.hpp"
#include "core/process/random.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

BlockSeries one_recording(std::size_t blocks, double block_s) {
  BlockSeries series;
  series.dt_s = block_s;
  series.recordings.resize(1);
  series.recordings[0].mean.assign(blocks, 0.0);
  series.recordings[0].filled.assign(blocks, 1.0);
  return series;
}

/// A recording of the model, one sample per block.
void draw(const SlowModel& model, double dt_s, Random& random, std::vector<double>& mean) {
  std::vector<double> state(model.components.size());
  for (std::size_t c = 0; c < state.size(); ++c) {
    const SlowComponent& component = model.components[c];
    state[c] =
        component.process.kind == &registered<GaussMarkov>() ? component.process.parameters[0] * random.normal() : 0.0;
  }
  for (double& v : mean) {
    v = std::sqrt(model.white / dt_s) * random.normal();
    for (std::size_t c = 0; c < state.size(); ++c) {
      const SlowComponent& component = model.components[c];
      v += state[c];
      if (component.process.kind == &registered<GaussMarkov>()) {
        const double phi = std::exp(-component.process.only_shape() * dt_s);
        state[c] = phi * state[c] + std::sqrt(component.process.square() * (1.0 - phi * phi)) * random.normal();
      } else {
        state[c] += component.process.parameters[0] * std::sqrt(dt_s) * random.normal();
      }
    }
  }
}

struct Noise {
  std::string name;
  SlowModel model;
};

std::vector<Noise> noises() {
  std::vector<Noise> all{{"white noise", {}}, {"Gauss-Markov", {}}, {"fast Gauss-Markov", {}}, {"random walk", {}}};
  for (Noise& noise : all) {
    noise.model.white = 1.0;
  }
  all[1].model.components = {slow_component(registered<GaussMarkov>(), 2.0, 0.03)};
  all[2].model.components = {slow_component(registered<GaussMarkov>(), 3.0, 1.0)};
  all[3].model.components = {slow_component(registered<RandomWalk>(), 0.01)};
  return all;
}

TEST(StepScan, ASearchedStepIsAsRareAsASingleLookOfItsGainLessTheCost) {
  constexpr std::size_t kBlocks = 1500;
  constexpr double kBlockS = 0.2;
  constexpr int kRuns = 2000;
  for (const Noise& noise : noises()) {
    BlockSeries series = one_recording(kBlocks, kBlockS);
    Random random(4711);
    int beyond = 0;
    for (int run = 0; run < kRuns; ++run) {
      draw(noise.model, kBlockS, random, series.recordings[0].mean);
      BlockColumns columns = BlockColumns::zeros(series, 2);
      for (std::size_t b = 0; b < kBlocks; ++b) {
        columns.rows[0][2 * b] = series.recordings[0].mean[b];
        columns.rows[0][2 * b + 1] = 1.0;  // the bias
      }
      const StepScan::Best best = StepScan(series, noise.model, columns).best_in(0);
      beyond += best.gain - best.search_cost > 3.8415 ? 1 : 0;
    }
    const double rate = static_cast<double>(beyond) / kRuns;
    // 5 % by the chi-square of one look; what forgets faster than a few blocks is charged up to twice its chance.
    EXPECT_GT(rate, 0.015) << noise.name;
    EXPECT_LT(rate, 0.07) << noise.name;
  }
}

}  // namespace
}  // namespace driftlab::investigate
