#include "core/navigate/outage_evaluation.hpp"

#include "core/navigate/outage_progress.hpp"
#include "core/navigate/outage_runs.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace driftlab {
namespace {

constexpr std::size_t kBatch = 20;
constexpr std::size_t kMostBatches = 200;  ///< where nothing hangs on what is known after each
constexpr std::size_t kTellings = 10;      ///< of what is known so far, where nothing hangs on it

/// Squared radius of the ellipse that holds a fraction of a plane normal distribution: -2 ln(1 - fraction).
double ellipse_bound(double fraction) { return -2.0 * std::log(1.0 - fraction); }

using Scores = decltype(OutageBatch::scores);

/// Mean and interval of independent values.
Estimate mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  Estimate estimate;
  estimate.value = sum / n;
  if (values.size() > 1) {
    double squares = 0.0;
    for (const double value : values) {
      squares += (value - estimate.value) * (value - estimate.value);
    }
    const double half = student_quantile(0.975, n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
    estimate.ci95 = {estimate.value - half, estimate.value + half};
  }
  return estimate;
}

/// One number per run: the mean of `value` over the outages of a filter.
template <class Value>
std::vector<double> per_run(const Scores& scores, std::size_t filter, const Value& value) {
  std::vector<double> out;
  out.reserve(scores.size());
  for (const auto& run : scores) {
    double sum = 0.0;
    for (const OutageScore& score : run[filter]) {
      sum += value(score);
    }
    out.push_back(sum / static_cast<double>(run[filter].size()));
  }
  return out;
}

template <class Value>
std::vector<double> at_outage(const Scores& scores, std::size_t filter, std::size_t outage, const Value& value) {
  std::vector<double> out;
  out.reserve(scores.size());
  for (const auto& run : scores) {
    out.push_back(value(run[filter][outage]));
  }
  return out;
}

double error_m(const OutageScore& score) { return score.error_m(); }
double nees(const OutageScore& score) { return score.nees(); }
double heading_squared(const OutageScore& score) { return score.heading_rad * score.heading_rad; }
double tilt_squared(const OutageScore& score) { return score.tilt_rad * score.tilt_rad; }
double within50(const OutageScore& score) { return score.nees() <= ellipse_bound(0.5) ? 1.0 : 0.0; }
double within95(const OutageScore& score) { return score.nees() <= ellipse_bound(0.95) ? 1.0 : 0.0; }

/// The value below which a fraction of the sorted values lies, linear between neighbours.
double quantile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  const double at = fraction * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

OutageSummary summarise(const Scores& scores, const OutageScenario& scenario, std::size_t filter, std::size_t outage,
                        int scatter_runs) {
  const auto mean = [&](const auto& value) { return mean_of(at_outage(scores, filter, outage, value)).value; };
  OutageSummary summary;
  summary.index = outage + 1;
  summary.start_s = scenario.outages[outage].start_s;
  summary.end_s = scenario.outages[outage].end_s();
  const std::vector<double> errors = at_outage(scores, filter, outage, error_m);
  summary.error_m = mean_of(errors);
  summary.median_m = quantile(errors, 0.5);
  summary.p95_m = quantile(errors, 0.95);
  summary.nees = mean_of(at_outage(scores, filter, outage, nees));
  summary.coverage50 = mean(within50);
  summary.coverage95 = mean(within95);
  summary.heading_rms_rad = std::sqrt(mean(heading_squared));
  summary.tilt_rms_rad = std::sqrt(mean(tilt_squared));
  summary.predicted = {mean([](const OutageScore& s) { return s.var_north; }),
                       mean([](const OutageScore& s) { return s.var_east; }),
                       mean([](const OutageScore& s) { return s.cov_north_east; })};
  summary.actual = {mean([](const OutageScore& s) { return s.north_m * s.north_m; }),
                    mean([](const OutageScore& s) { return s.east_m * s.east_m; }),
                    mean([](const OutageScore& s) { return s.north_m * s.east_m; })};
  summary.rms_m = std::sqrt(summary.actual.north + summary.actual.east);
  summary.mean_north_m = mean([](const OutageScore& s) { return s.north_m; });
  summary.mean_east_m = mean([](const OutageScore& s) { return s.east_m; });
  for (std::size_t run = 0; run < scores.size() && run < static_cast<std::size_t>(std::max(scatter_runs, 0)); ++run) {
    const OutageScore& score = scores[run][filter][outage];
    summary.scatter.push_back({score.north_m, score.east_m});
  }
  return summary;
}

FilterEvaluation evaluation_of(const Scores& scores, const OutageExperiment& experiment, std::size_t filter,
                               int scatter_runs) {
  const OutageScenario& scenario = experiment.scenario();
  const auto mean = [&](const auto& value) { return mean_of(per_run(scores, filter, value)).value; };
  FilterEvaluation result;
  result.name = scenario.filters[filter].name;
  result.about = scenario.filters[filter].about;
  result.states = 9 + experiment.design(filter).sensor_states();
  result.mean_error_m = mean_of(per_run(scores, filter, error_m));
  result.nees = mean_of(per_run(scores, filter, nees));
  result.coverage50 = mean(within50);
  result.coverage95 = mean(within95);
  result.heading_rms_rad = std::sqrt(mean(heading_squared));
  result.tilt_rms_rad = std::sqrt(mean(tilt_squared));
  for (std::size_t outage = 0; outage < scenario.outages.size(); ++outage) {
    result.outages.push_back(summarise(scores, scenario, filter, outage, scatter_runs));
  }
  return result;
}

std::vector<double> difference_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), [](double x, double y) { return x - y; });
  return out;
}

PairedDifference compare(const Scores& scores, const OutageScenario& scenario, std::size_t filter,
                         std::size_t against) {
  const std::vector<double> mine = per_run(scores, filter, error_m);
  const std::vector<double> theirs = per_run(scores, against, error_m);
  PairedDifference pair;
  pair.filter = scenario.filters[filter].name;
  pair.against = scenario.filters[against].name;
  pair.difference_m = mean_of(difference_of(mine, theirs));
  // Ratio of means R: by the delta method its error is the mean of (a - R b)/mean(b).
  const double base = mean_of(theirs).value;
  const double ratio = mean_of(mine).value / base;
  std::vector<double> residual(mine.size());
  std::transform(mine.begin(), mine.end(), theirs.begin(), residual.begin(),
                 [&](double a, double b) { return (a - ratio * b) / base; });
  const Estimate spread = mean_of(residual);
  pair.relative.value = ratio - 1.0;
  pair.relative.ci95 = {ratio - 1.0 + spread.ci95.low - spread.value, ratio - 1.0 + spread.ci95.high - spread.value};
  for (std::size_t outage = 0; outage < scenario.outages.size(); ++outage) {
    pair.by_outage_m.push_back(mean_of(
        difference_of(at_outage(scores, filter, outage, error_m), at_outage(scores, against, outage, error_m))));
  }
  return pair;
}

bool precise_enough(const Scores& scores, std::size_t filters, double relative_precision) {
  for (std::size_t f = 0; f < filters; ++f) {
    const Estimate mean = mean_of(per_run(scores, f, error_m));
    if (mean.ci95.high - mean.value > relative_precision * mean.value) {
      return false;
    }
  }
  return true;
}

/// What is known after these runs, as the stage of those that follow.
std::string stage_after(const Scores& scores, const OutageScenario& scenario) {
  OutagesSoFar known{scores.size(), {}};
  for (std::size_t f = 0; f < scenario.filters.size(); ++f) {
    known.filters.push_back({scenario.filters[f].name, mean_of(per_run(scores, f, error_m))});
  }
  return stage_of(known);
}

}  // namespace

double OutageScore::error_m() const { return std::hypot(north_m, east_m); }

double OutageScore::nees() const {
  const double determinant = var_north * var_east - cov_north_east * cov_north_east;
  return (var_east * north_m * north_m - 2.0 * cov_north_east * north_m * east_m + var_north * east_m * east_m) /
         determinant;
}

std::optional<PairedDifference> OutageEvaluation::difference(std::string_view filter, std::string_view against) const {
  for (const PairedDifference& pair : paired) {
    if (pair.filter == filter && pair.against == against) {
      return pair;
    }
  }
  return std::nullopt;
}

struct OutageBatches::State {
  OutageExperiment experiment;
  OutageOptions options;
  std::size_t most = 0;   ///< runs
  std::size_t batch = 0;  ///< runs of each, of the last the rest
  std::size_t telling = 0;
  Scores scores = {};  ///< of the batches taken
  DrawnRun drawn = {};
  bool stopped_early = false;
  std::string stage = "outages";
};

OutageBatches::OutageBatches(std::unique_ptr<State> state) : state_(std::move(state)) {}
OutageBatches::OutageBatches(OutageBatches&&) noexcept = default;
OutageBatches& OutageBatches::operator=(OutageBatches&&) noexcept = default;
OutageBatches::~OutageBatches() = default;

Result<OutageBatches> OutageBatches::make(const OutageScenario& scenario, const OutageOptions& options,
                                          const std::stop_token& stop) {
  if (options.runs < 2 || options.runs > 100000 || !(options.relative_precision >= 0.0)) {
    return fail(ErrorCode::InvalidArgument,
                "An evaluation takes 2 to 100000 runs and a precision that is not negative.", {{"parameter", "runs"}});
  }
  auto experiment = OutageExperiment::make(scenario, stop);
  if (!experiment) {
    return fail(experiment.error());
  }
  const auto most = static_cast<std::size_t>(options.runs);
  const bool may_stop = options.relative_precision > 0.0;
  const std::size_t batch = may_stop ? kBatch : std::max(kBatch, most / kMostBatches);
  const std::size_t telling = may_stop ? kBatch : std::max(2 * kBatch, most / kTellings);
  return OutageBatches(std::make_unique<State>(State{std::move(*experiment), options, most, batch, telling}));
}

std::size_t OutageBatches::count() const { return (state_->most + state_->batch - 1) / state_->batch; }

Result<OutageBatch> OutageBatches::run(std::size_t number, const RunControl& control) const {
  const std::size_t first = number * state_->batch;
  const std::size_t count = std::min(state_->batch, state_->most - first);
  OutageBatch batch;
  batch.scores.resize(count);
  std::atomic<std::size_t> done{0};
  const auto caller = std::this_thread::get_id();  // of the threads that share the runs it alone reports
  const auto task = [&](std::size_t i) {
    const std::size_t run = first + i;
    batch.scores[i] =
        state_->experiment.run(state_->options.seed, run, run == 0 ? &batch.drawn : nullptr, control.stop);
    const std::size_t finished = ++done;
    if (std::this_thread::get_id() == caller) {
      control.report(state_->stage, static_cast<double>(finished) / static_cast<double>(count));
    }
  };
  parallel_for(control.threads, count, task, control.stop);
  if (control.stop.stop_requested()) {
    return fail(ErrorCode::Cancelled, "The outage evaluation was cancelled.");
  }
  return batch;
}

Result<bool> OutageBatches::add(OutageBatch batch) {
  const OutageScenario& scenario = state_->experiment.scenario();
  Scores& scores = state_->scores;
  const std::size_t expected = std::min(state_->batch, state_->most - scores.size());
  bool fits = batch.scores.size() == expected;
  for (const auto& run : batch.scores) {
    fits = fits && run.size() == scenario.filters.size() &&
           std::all_of(run.begin(), run.end(),
                       [&](const auto& filter) { return filter.size() == scenario.outages.size(); });
  }
  if (scores.empty()) {
    fits = fits && batch.drawn.paths.size() == scenario.filters.size() &&
           batch.drawn.tracks.size() == scenario.filters.size() &&
           std::all_of(batch.drawn.tracks.begin(), batch.drawn.tracks.end(),
                       [&](const auto& tracks) { return tracks.size() == scenario.outages.size(); });
  }
  if (!fits) {
    return fail(ErrorCode::InvalidArgument, "The batch of runs is not one of this evaluation.");
  }
  if (scores.empty()) {
    state_->drawn = std::move(batch.drawn);
  }
  const std::size_t told = scores.size() / state_->telling;
  scores.insert(scores.end(), std::make_move_iterator(batch.scores.begin()),
                std::make_move_iterator(batch.scores.end()));
  if (scores.size() / state_->telling > told) {
    state_->stage = stage_after(scores, scenario);
  }
  if (scores.size() == state_->most) {
    return false;
  }
  const double precision = state_->options.relative_precision;
  state_->stopped_early = precision > 0.0 && precise_enough(scores, scenario.filters.size(), precision);
  return !state_->stopped_early;
}

const std::string& OutageBatches::stage() const { return state_->stage; }

OutageEvaluation OutageBatches::evaluate() const {
  const OutageExperiment& experiment = state_->experiment;
  const OutageScenario& scenario = experiment.scenario();
  OutageEvaluation result;
  result.stopped_early = state_->stopped_early;
  result.scenario = scenario.name;
  result.runs = static_cast<int>(state_->scores.size());
  result.seed = state_->options.seed;
  result.truth = experiment.true_path();
  result.true_tracks = experiment.true_tracks();
  for (std::size_t f = 0; f < scenario.filters.size(); ++f) {
    result.filters.push_back(evaluation_of(state_->scores, experiment, f, state_->options.scatter_runs));
    result.filters.back().path = state_->drawn.paths[f];
    for (std::size_t outage = 0; outage < scenario.outages.size(); ++outage) {
      result.filters.back().outages[outage].track = state_->drawn.tracks[f][outage];
    }
    for (std::size_t against = 0; against < scenario.filters.size(); ++against) {
      if (against != f) {
        result.paired.push_back(compare(state_->scores, scenario, f, against));
      }
    }
  }
  return result;
}

Result<OutageEvaluation> evaluate_outages(const OutageScenario& scenario, const OutageOptions& options,
                                          const RunControl& control) {
  control.report("trajectory", 0.0);
  auto batches = OutageBatches::make(scenario, options, control.stop);
  if (!batches) {
    return fail(batches.error());
  }
  const auto count = static_cast<double>(batches->count());
  bool more = true;
  for (std::size_t number = 0; more; ++number) {
    const auto done = static_cast<double>(number);
    const RunControl part = control.reporting(
        [&](std::string_view stage, double fraction) { control.report(stage, (done + fraction) / count); });
    auto batch = batches->run(number, part);
    if (!batch) {
      return fail(batch.error());
    }
    const auto added = batches->add(std::move(*batch));
    if (!added) {
      return fail(added.error());
    }
    more = *added;
  }
  control.report("outages", 1.0);
  return batches->evaluate();
}

}  // namespace driftlab
