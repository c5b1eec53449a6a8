// Octave variances in units of one vectorised sum of the same array ("reads"): run both, divide.
#include "core/process/random.hpp"
#include "core/variance/allan_variance.hpp"
#include "core/variance/contamination.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/robust_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/bench/recorded_axes.hpp"

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <algorithm>

namespace driftlab {
namespace {

const std::vector<double>& series(std::size_t samples) {
  static std::vector<double> values;
  if (values.size() != samples) {
    Random random(1);
    values.resize(samples);
    std::generate(values.begin(), values.end(), [&] { return random.normal(); });
  }
  return values;
}

/// The sum of the array with the vectors of the widest instruction set: a pyramid step of the array with zeros would do
/// more.
double vector_sum(const double* x, std::size_t count) {
  return Eigen::Map<const Eigen::VectorXd>(x, static_cast<Eigen::Index>(count)).sum();
}

void OneRead(benchmark::State& state) {  // NOLINT(readability-identifier-naming): benchmark names are stable
  const auto& x = series(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(vector_sum(x.data(), x.size()));
  }
}

void OctaveVariances(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const auto& x = series(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(haar_variance(x, 0.0));
  }
}

void RobustVariances(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const auto& x = series(static_cast<std::size_t>(state.range(0)));
  const HaarVariance curve = haar_variance(x, 0.0);
  for (auto _ : state) {
    HaarCovariance plan(curve.half, x.size(), 1.0);
    const VarianceIntervals intervals = variance_intervals(curve, plan);
    benchmark::DoNotOptimize(robust_variance(x, 0.0, curve, intervals, plan));
  }
}

void TwoHundredTaus(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const auto& x = series(static_cast<std::size_t>(state.range(0)));
  const auto m = log_spaced_half_lengths(x.size(), 200);
  for (auto _ : state) {
    benchmark::DoNotOptimize(allan_variance(x, 0.0, m));
  }
}

/// The six recorded axes of 10^6 samples, one after the other.
void OctaveVariancesRecorded(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  for (auto _ : state) {
    for (const std::vector<double>& x : recorded_axes::adis(state)) {
      benchmark::DoNotOptimize(haar_variance(x, 0.0));
    }
  }
}

void TwoHundredTausRecorded(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  for (auto _ : state) {
    for (const std::vector<double>& x : recorded_axes::adis(state)) {
      benchmark::DoNotOptimize(allan_variance(x, 0.0, log_spaced_half_lengths(x.size(), 200)));
    }
  }
}

BENCHMARK(OneRead)->Arg(1000000)->Arg(10000000)->Unit(benchmark::kMillisecond);
BENCHMARK(OctaveVariances)->Arg(1000000)->Arg(10000000)->Unit(benchmark::kMillisecond);
BENCHMARK(TwoHundredTaus)->Arg(1000000)->Arg(10000000)->Unit(benchmark::kMillisecond);
BENCHMARK(RobustVariances)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(OctaveVariancesRecorded)->Unit(benchmark::kMillisecond);
BENCHMARK(TwoHundredTausRecorded)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace driftlab
