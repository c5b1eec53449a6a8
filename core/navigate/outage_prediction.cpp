#include "core/navigate/outage_prediction.hpp"

#include "core/navigate/paper_scenario.hpp"

#include <algorithm>

namespace driftlab {
namespace {

constexpr const char* kBaseline = "baseline";
constexpr const char* kExtended = "extended";

/// The scenario's models with those of the given channels in their place.
ImuModel merged(const ImuModel& scenario, const SensorErrorModel& given) {
  ImuModel model = scenario;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    if (const auto& axis = given.axes[c]; axis.has_value()) {
      model.axes[c] = *axis;
    }
  }
  return model;
}

/// What of a model a filter can hold.
ImuModel for_filter(const ImuModel& model, double dt_s, std::vector<std::string>& left_out) {
  ImuModel held = model;
  for (AxisModel& axis : held.axes) {
    axis.processes = axis.processes.without([&](const Process& process) {
      if (process.state_space(dt_s)) {
        return false;
      }
      std::string name(process.kind->name);
      if (std::find(left_out.begin(), left_out.end(), name) == left_out.end()) {
        left_out.push_back(std::move(name));
      }
      return true;
    });
  }
  return held;
}

FilterCandidate believing(const char* name, const ImuModel& model, const OutageScenario& scenario) {
  FilterCandidate filter;
  filter.name = name;
  if (!scenario.filters.empty()) {
    filter.settings = scenario.filters.front().settings;
  } else {
    filter.settings.initial = scenario.initial;
    filter.settings.lever_arm_m = scenario.gnss.lever_arm_m;
  }
  filter.settings.imu = model;
  return filter;
}

/// The second of two evaluations, which are as long as three filters' runs.
RunControl share_of(const RunControl& control, double from, double share) {
  return control.reporting([&control, from, share](std::string_view stage, double fraction) {
    control.report(stage, from + share * fraction);
  });
}

}  // namespace

OutageScenario prediction_scenario() {
  OutageScenario scenario = *paper_scenario("paper");  // the name is known
  constexpr double kEnd = 205.0;
  scenario.name = "two turns";
  scenario.about = "The first two turns of the paper's drive.";
  scenario.drive.duration_s = kEnd;
  std::erase_if(scenario.drive.segments, [](const Segment& s) { return s.start_s >= kEnd; });
  std::erase_if(scenario.outages, [](const Outage& o) { return o.end_s() > kEnd; });
  scenario.imu_rate_hz = 20.0;
  scenario.filters.resize(1);
  scenario.filters.front().settings.covariance_samples = 5;
  return scenario;
}

Result<OutagePrediction> predict_outage_errors(const SensorErrorModel& baseline, const SensorErrorModel& extended,
                                               const OutageScenario& scenario, const PredictionOptions& options,
                                               const RunControl& control) {
  OutagePrediction prediction;
  const double dt_s = scenario.imu_rate_hz > 0.0 ? 1.0 / scenario.imu_rate_hz : 0.0;
  const ImuModel promised = merged(scenario.truth, baseline);
  const ImuModel found = merged(scenario.truth, extended);
  const FilterCandidate old_filter = believing(kBaseline, for_filter(promised, dt_s, prediction.left_out), scenario);
  const FilterCandidate new_filter = believing(kExtended, for_filter(found, dt_s, prediction.left_out), scenario);

  OutageOptions evaluation;
  evaluation.runs = options.runs;
  evaluation.seed = options.seed;
  evaluation.scatter_runs = 0;
  OutageScenario before = scenario;
  before.truth = promised;
  before.hardware = baseline.hardware;
  before.filters = {old_filter};
  const auto as_promised = evaluate_outages(before, evaluation, share_of(control, 0.0, 1.0 / 3.0));
  if (!as_promised) {
    return fail(as_promised.error());
  }
  OutageScenario after = scenario;
  after.truth = found;
  after.hardware = extended.hardware;
  after.filters = {old_filter, new_filter};
  const auto as_found = evaluate_outages(after, evaluation, share_of(control, 1.0 / 3.0, 2.0 / 3.0));
  if (!as_found) {
    return fail(as_found.error());
  }
  prediction.runs = as_found->runs;
  prediction.baseline_m = as_promised->filters[0].mean_error_m;
  prediction.extended_m = as_found->filters[0].mean_error_m;
  prediction.adopted_m = as_found->filters[1].mean_error_m;
  if (const auto pair = as_found->difference(kExtended, kBaseline)) {
    prediction.adoption_gain_m = pair->difference_m;
  }
  return prediction;
}

}  // namespace driftlab
