// Samples a second that one filter takes: 9 navigation states, a bias per axis (15), and two Gauss-Markov states per
// gyro (21).
#include "core/navigate/outage_runs.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <benchmark/benchmark.h>

namespace driftlab {
namespace {

OutageScenario drive_with(int states, int covariance_samples) {
  OutageScenario scenario = *paper_scenario("paper");
  FilterCandidate filter = scenario.filters[states == 15 ? 0 : 2];
  for (std::size_t c = 3; c < kImuChannels; ++c) {  // accelerometers with a bias alone
    filter.settings.imu.axes[c].processes =
        ModelSchedule::constant({filter.settings.imu.axes[c].processes.model(0).front()});
  }
  filter.settings.covariance_samples = covariance_samples;
  scenario.filters = {filter};
  return scenario;
}

/// The paper's drive with fixes at 1 Hz through one filter.
void FilterSamples(benchmark::State& state) {  // NOLINT(readability-identifier-naming): benchmark names are stable
  const OutageScenario scenario = drive_with(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const OutageExperiment experiment = *OutageExperiment::make(scenario);
  const Trajectory& truth = experiment.truth();
  const ImuRun imu = simulate_imu(truth.imu, truth.dt_s, scenario.truth, {}, 1, 0);
  Random random(1, 8);
  const auto fixes = simulate_gnss(truth, scenario.gnss, {}, random);
  for (auto _ : state) {
    NavigationFilter filter(experiment.design(0), truth.states.front());
    for (std::size_t k = 0; k < fixes.size(); ++k) {
      filter.advance(std::span(imu.readings).subspan(100 * k, 100));
      filter.update(fixes[k]);
    }
    benchmark::DoNotOptimize(filter.state().position_ecef_m.x());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(imu.readings.size()));
  state.counters["states"] = 9 + experiment.design(0).sensor_states();
}

void SimulateRun(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const OutageScenario scenario = *paper_scenario("paper");
  const OutageExperiment experiment = *OutageExperiment::make(scenario);
  std::uint64_t run = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        simulate_imu(experiment.truth().imu, experiment.truth().dt_s, scenario.truth, {}, 1, run++).readings.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(experiment.truth().imu.size()));
}

BENCHMARK(FilterSamples)
    ->Args({21, 10})
    ->Args({21, 1})
    ->Args({15, 10})
    ->ArgNames({"states", "covariance_samples"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(SimulateRun)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace driftlab
