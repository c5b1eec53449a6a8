// Fits: nine ranked models from given variances, and whole recordings.
#include "core/fit/candidate_set.hpp"
#include "core/fit/characterise.hpp"
#include "core/fit/fit_report.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "core/variance/variance_intervals.hpp"
#include "tests/bench/recorded_axes.hpp"
#include "tests/likelihood/kalman_likelihood.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// A phone gyroscope at rest: white noise, a fast Gauss-Markov process, a random walk [deg/s].
Model phone() {
  return {*make_process("white_noise", {0.0172}), *make_process("gauss_markov", {0.0442, 1.71}),
          *make_process("random_walk", {0.0024})};
}

std::vector<double> series(std::size_t samples, std::uint64_t seed) {
  Random random(seed);
  return simulate(phone(), random, kDt, samples);
}

/// Nine models fitted to given wavelet variances, ranked, with previews for all and profiled intervals for the best.
void RankNineModels(benchmark::State& state) {  // NOLINT(readability-identifier-naming): benchmark names are stable
  const auto samples = static_cast<std::size_t>(state.range(0));
  HaarVariance curve = haar_variance(series(samples, 1), 0.0);
  const double unit = *std::max_element(curve.variance.begin(), curve.variance.end());
  for (double& variance : curve.variance) {
    variance /= unit;
  }
  HaarCovariance first(curve.half, samples, kDt);
  const VarianceIntervals intervals = variance_intervals(curve, first);
  const Eigen::VectorXd sd = intervals.estimate_variance.cwiseSqrt();
  std::vector<ModelStructure> structures;
  for (const std::string& name : CharacteriseOptions{}.models) {
    structures.push_back(*parse_model(name));
  }
  for (auto _ : state) {
    HaarCovariance plan(curve.half, samples, kDt);
    const WaveletMoments moments{
        Eigen::Map<const Eigen::VectorXd>(curve.variance.data(), static_cast<Eigen::Index>(curve.scales())),
        {plan.half().begin(), plan.half().end()},
        static_cast<double>(samples),
        kDt};
    const CurveCovariance logarithms =
        curve_covariance(moments.nu, modelled_variance(moments, intervals.mixture), plan.matrix(intervals.mixture));
    CandidateSet set = *fit_candidates(moments, structures, sd, logarithms);
    benchmark::DoNotOptimize(forgive(moments, set));
    std::vector<Candidate>& candidates = set.candidates;
    std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
      return a.criterion(moments.samples) < b.criterion(moments.samples);
    });
    for (Candidate& candidate : candidates) {
      const bool best = &candidate == &candidates.front();
      benchmark::DoNotOptimize(
          report_fit(candidate, 1.0, moments.samples, best ? IntervalMethod::Profile : IntervalMethod::Preview));
    }
  }
}

/// Everything about one channel: variances, intervals, robust variances, contamination, nine models, Allan regression.
void CharacteriseChannel(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const std::vector<double> x = series(static_cast<std::size_t>(state.range(0)), 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(characterise_channel({.values = x, .dt_s = kDt}));
  }
}

/// The same over recordings that grow tenfold: the counter, nanoseconds a sample, stays. The series of a million
/// samples is repeated, each time from where the last one ended, so that making it costs little beside analysing it.
void CharacteriseLongChannel(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const std::vector<double> part = series(1000000, 4);
  std::vector<double> x(static_cast<std::size_t>(state.range(0)));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t turn = i / part.size();
    // Every other time backwards: without it the ends would not meet.
    x[i] = turn % 2 == 0 ? part[i % part.size()] : part[part.size() - 1 - i % part.size()];
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(characterise_channel({.values = x, .dt_s = kDt}));
  }
  state.counters["ns_per_sample"] = benchmark::Counter(1e-9 * static_cast<double>(x.size()),
                                                       benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// A recording of 15 minutes at 100 Hz, six axes.
void SixAxesFifteenMinutes(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  std::vector<std::vector<double>> axes;
  for (std::uint64_t axis = 0; axis < 6; ++axis) {
    axes.push_back(series(90000, 10 + axis));
  }
  for (auto _ : state) {
    for (const std::vector<double>& x : axes) {
      benchmark::DoNotOptimize(characterise_channel({.values = x, .dt_s = kDt}));
    }
  }
}

/// The six recorded axes of an ADIS16405, the first `range` samples of each: promised in 1.2 s of processor time for
/// 10^6.
void SixRecordedAxes(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const auto samples = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    for (const std::vector<double>& x : recorded_axes::adis(state)) {
      const std::vector<double> part(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(std::min(samples, x.size())));
      benchmark::DoNotOptimize(characterise_channel({.values = part, .dt_s = kDt}));
    }
  }
}

void KalmanLikelihoodOf(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const std::vector<double> x = series(90000, 3);
  const Model model = phone();
  for (auto _ : state) {
    benchmark::DoNotOptimize(kalman_likelihood(x, model, kDt));
  }
}

BENCHMARK(RankNineModels)->Arg(90000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(CharacteriseChannel)->Arg(90000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(CharacteriseLongChannel)
    ->RangeMultiplier(10)
    ->Range(1000000, 100000000)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(SixAxesFifteenMinutes)->Unit(benchmark::kMillisecond);
BENCHMARK(SixRecordedAxes)->Arg(90000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(KalmanLikelihoodOf)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace driftlab
