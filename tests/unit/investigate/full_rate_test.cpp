/// Innovations sample by sample are those of the filter over blocks of one sample, wherever samples are missing.
#include "core/investigate/fullrate/full_rate.hpp"

#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

TEST(FullRate, InnovationsAreThoseOfBlocksOfOneSample) {
  constexpr std::size_t kCount = 4000;
  NoiseAtFullRate noise({white(kCount, 1), white(kCount, 2), white(kCount - 500, 3)});
  std::vector<unsigned char> holes(kCount, 1);
  for (std::size_t i = 700; i < kCount; i += 90) {
    holes[i] = holes[i + 1] = 0;
  }
  noise.channels[0].valid = Presence(kCount);
  noise.channels[1].valid = Presence(holes);
  noise.channels[2].valid = Presence(kCount - 500);
  noise.recordings[0].begin = 100;
  for (std::size_t r = 0; r < 3; ++r) {
    noise.channels[r].error = noise.data.residual[r];
  }
  std::vector<std::vector<unsigned char>> mask(3);
  mask[2].assign(kCount - 500, 0);
  mask[2][1234] = 1;
  SlowModel model;
  model.white = 0.02;
  model.components = {slow_component(registered<GaussMarkov>(), 0.3, 2.0),
                      slow_component(registered<RandomWalk>(), 1e-3, 0.0, {1, 1, 0})};
  FullRateOptions options;
  options.given = true;
  options.whiten_further = false;
  std::vector<Series> residual;
  BlockColumns columns;
  columns.width = 1;
  for (std::size_t r = 0; r < 3; ++r) {
    residual.push_back(noise.channels[r].error.part(noise.recordings[r].begin, noise.recordings[r].count()));
    columns.rows.push_back(residual.back().values());
  }
  const Study study;
  const FullRate data = look_at_full_rate(study, noise.group, model, residual, mask, options);
  const BlockSeries samples = average_blocks(noise.group, mask, true);
  const Whitened expected = whiten(samples, model, columns);
  double variances = 0.0;
  double used = 0.0;
  std::size_t row = 0;
  for (std::size_t r = 0; r < 3; ++r) {
    ASSERT_EQ(data.innovation[r].values(), expected.columns.rows[r]) << r;
    for (std::size_t i = 0; i < data.used[r].size(); ++i, ++row) {
      ASSERT_EQ(data.used[r][i] != 0, samples.recordings[r].filled[i] > 0.0) << r << ' ' << i;
      variances += data.used[r][i] != 0 ? std::exp(expected.log_var[row]) : 0.0;
      used += data.used[r][i] != 0 ? 1.0 : 0.0;
    }
  }
  EXPECT_EQ(data.innovation_sd, std::sqrt(variances / used));
  options.innovations = false;
  const FullRate spectra = look_at_full_rate(study, noise.group, model, residual, mask, options);
  EXPECT_TRUE(spectra.innovation.empty());
  ASSERT_EQ(spectra.spectrum.size(), data.spectrum.size());
  EXPECT_FALSE(data.spectrum[0].power.empty());
  EXPECT_FALSE(data.spectrum[1].power.empty()) << "two of ninety samples are missing";
  EXPECT_EQ(data.spectrum[0].broken, 0.0);
  EXPECT_GT(data.spectrum[1].broken, 0.0);
  EXPECT_EQ(spectra.spectrum[0].power, data.spectrum[0].power);
}

/// The spectrum of a recording of which every `every`-th sample is missing.
Spectrum seen_with_gaps(std::vector<double> values, std::size_t every) {
  NoiseAtFullRate noise({std::move(values)});
  std::vector<unsigned char> there(noise.recordings[0].length, 1);
  for (std::size_t i = every; i < there.size(); i += every) {
    there[i] = 0;
  }
  noise.channels[0].valid = Presence(there);
  noise.channels[0].error = noise.data.residual[0];
  SlowModel model;
  model.white = 0.02;
  FullRateOptions options;
  options.innovations = false;
  const Study study;
  return look_at_full_rate(study, noise.group, model, {noise.channels[0].error}, {}, options).spectrum[0];
}

TEST(FullRate, ASpectrumThatGapsWouldFillIsNotTaken) {
  const std::vector<double> level = white(4000, 1);
  std::vector<double> differenced(level.size());
  for (std::size_t i = 1; i < level.size(); ++i) {
    differenced[i] = level[i] - level[i - 1];
  }
  EXPECT_FALSE(seen_with_gaps(level, 50).power.empty());
  EXPECT_TRUE(seen_with_gaps(level, 7).power.empty()) << "too much is missing";
  EXPECT_FALSE(seen_with_gaps(differenced, 500).power.empty());
  EXPECT_TRUE(seen_with_gaps(differenced, 50).power.empty()) << "it has no power at low frequencies";
}

}  // namespace
}  // namespace driftlab::investigate
