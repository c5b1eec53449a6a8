// The sample-wise robust variance of 10^6 samples: promised in 1 s of processor time.
#include "core/fit/sample_wise_variance.hpp"
#include "core/process/model.hpp"
#include "tests/bench/recorded_axes.hpp"

#include <benchmark/benchmark.h>

#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kSamples = 1000000;

GappySamples spoiled(const Model& model) {
  Random random(1);
  GappySamples samples{simulate(model, random, 1.0, kSamples), {}};
  for (double& value : samples.values) {
    value += random.uniform() < 0.01 ? 100.0 * random.normal() : 0.0;
  }
  return samples;
}

void estimate(benchmark::State& state, const Model& model) {
  const GappySamples samples = spoiled(model);
  std::vector<std::size_t> half;
  for (std::size_t m = 1; 2 * m <= kSamples; m *= 2) {
    half.push_back(m);
  }
  for (auto _ : state) {
    HaarCovariance plan(half, kSamples, 1.0);
    benchmark::DoNotOptimize(sample_wise_variance(samples, plan));
  }
}

void SampleWiseWhite(benchmark::State& state) {  // NOLINT(readability-identifier-naming): benchmark names are stable
  estimate(state, {*make_process("white_noise", {1.0})});
}

void SampleWiseComposite(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  estimate(state, {*make_process("white_noise", {1.0}), *make_process("gauss_markov", {0.3, 0.02}),
                   *make_process("random_walk", {0.001})});
}

void SampleWiseQuantized(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  estimate(state, {*make_process("quantization_noise", {1.0}), *make_process("white_noise", {0.3})});
}

/// The six recorded axes of 10^6 samples, one after the other.
void SampleWiseRecorded(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  std::vector<std::size_t> half;
  for (std::size_t m = 1; 2 * m <= kSamples; m *= 2) {
    half.push_back(m);
  }
  for (auto _ : state) {
    for (const std::vector<double>& x : recorded_axes::adis(state)) {
      HaarCovariance plan(half, x.size(), 1.0);
      benchmark::DoNotOptimize(sample_wise_variance({x, {}}, plan));
    }
  }
}

BENCHMARK(SampleWiseWhite)->Unit(benchmark::kMillisecond);
BENCHMARK(SampleWiseComposite)->Unit(benchmark::kMillisecond);
BENCHMARK(SampleWiseQuantized)->Unit(benchmark::kMillisecond);
BENCHMARK(SampleWiseRecorded)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace driftlab
