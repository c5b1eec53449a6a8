/// Parameters and intervals of what the slow search has accepted.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/slow_search.hpp"
#include "core/investigate/slow/step_scan.hpp"
#include "core/process/distributions.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

void SlowSearch::describe(Evidence& evidence) const {
  if (evidence.cause->as<MeanEffect>() != nullptr) {
    describe_mean(evidence);
  } else {
    describe_slow(evidence);
  }
}

/// The widest base that a given or automatic baseline allows, none of its processes at rest. The search keeps a process
/// only where it pays; an interval that took the chosen base for certain would be too short where slow noise hides
/// below that price, and for recorded noise it always does.
SlowModel SlowSearch::widest_base(const BlockColumns& columns) const {
  SlowModel model = null_.model;
  if (given_ || !extra_.empty() || orders_.empty()) {
    return model;
  }
  const auto richer = [](const SlowFit& a, const SlowFit& b) { return a.log_likelihood < b.log_likelihood; };
  model = std::max_element(orders_.begin(), orders_.end(), richer)->model;
  const double level = model.white / series_.block_s();
  const ProcessKind& walk = registered<RandomWalk>();
  if (model.count(walk) == 0) {
    model.components.push_back(slow_component(walk, 0.0));
  }
  for (SlowComponent& component : model.components) {
    raise_square(component, at_record_length(component.kind(), 0.003 * level, series_.longest_s()));
  }
  return fit_slow(series_, columns, model, freedom()).model;
}

void SlowSearch::describe_mean(Evidence& evidence) const {
  const auto position = regressor_of(evidence);
  const auto mine = std::find_if(accepted_.begin(), accepted_.end(), [&](const Regressor& r) {
    return r.cause == evidence.cause && r.members == evidence.members;
  });
  if (!position || mine == accepted_.end()) {
    return;
  }
  const Cause& cause = *evidence.cause;
  const MeanEffect& effect = *cause.as<MeanEffect>();
  evidence.shape = mine->shape;
  BlockColumns columns = columns_with(accepted_);
  // The shape is uncertain too: its derivative is one more regressor while the amplitude's interval is sought.
  if (effect.refinement.refined()) {
    const double step = effect.refinement.difference(mine->shape);
    std::vector<Regressor> moved = accepted_;
    moved[static_cast<std::size_t>(mine - accepted_.begin())].shape += step;
    const BlockColumns there = columns_with(moved);
    BlockColumns wider = BlockColumns::zeros(series_, columns.width + 1);
    for (std::size_t r = 0; r < columns.rows.size(); ++r) {
      for (std::size_t b = 0; b * columns.width < columns.rows[r].size(); ++b) {
        for (std::size_t c = 0; c < columns.width; ++c) {
          wider.rows[r][b * wider.width + c] = columns.rows[r][b * columns.width + c];
        }
        const std::size_t at = b * columns.width + *position + 1;
        wider.rows[r][b * wider.width + columns.width] = (there.rows[r][at] - columns.rows[r][at]) / step;
      }
    }
    columns = std::move(wider);
  }
  const SlowFit here = evaluate_slow(series_, columns, null_.model);
  const SlowFit fit = evaluate_slow(series_, columns, widest_base(columns));
  const Unit& unit = group_.unit;
  const auto index = static_cast<Eigen::Index>(*position);
  if (effect.free_phase) {
    // One amplitude from the moduli of all recordings, each less the noise's share: A ~ m - var/(2 m).
    double weight = 0.0;
    double mean = 0.0;
    double count = 0.0;
    for (Eigen::Index k = index; k + 1 < index + mine->columns; k += 2) {
      const double variance = 0.5 * (fit.amplitude_covariance(k, k) + fit.amplitude_covariance(k + 1, k + 1));
      const double modulus = std::hypot(fit.amplitude[k], fit.amplitude[k + 1]);
      const bool seen = modulus * modulus > 0.0 && variance < 1e6 * modulus * modulus;
      if (seen && variance > 0.0) {
        weight += 1.0 / variance;
        mean += modulus / variance;
        count += 1.0;
      }
    }
    mean /= weight;
    const double value = mean - 0.5 * count / weight / mean;
    const double half = kNormal975 / std::sqrt(weight);
    evidence.parameters = {{std::string(cause.parameters[0].name),
                            {value, {std::max(0.0, value - half), value + half}},
                            cause.parameters[0].unit(unit)}};
    return;
  }
  Interval interval = profile_amplitude(series_, columns, fit, *position + 1, freedom());
  const double value = here.amplitude[index];
  interval = {std::min(interval.low, value), std::max(interval.high, value)};
  const CauseParameter& first = amplitude_of(cause, evidence.shape);
  evidence.parameters = {{std::string(first.name), {value, interval}, first.unit(unit)}};
  if (effect.change_point) {
    place_step(evidence);
  } else if (effect.refinement.refined()) {
    const auto which = static_cast<std::size_t>(mine - accepted_.begin());
    const auto at = [&](double shape) {
      if (stop_.stop_requested()) {
        return 0.0;
      }
      std::vector<Regressor> moved = accepted_;
      moved[which].shape = effect.refinement.nearest(shape);
      SlowFreedom quick = freedom();
      quick.iterations = 3;
      return fit_slow(series_, columns_with(moved), fit.model, quick).log_likelihood;
    };
    const double top = at(evidence.shape);
    const double sd = effect.refinement.usual_error(evidence.shape);
    const auto [lowest, highest] = effect.refinement.bounds(evidence.shape);
    const Interval place{evidence.shape > lowest ? profile_end(evidence.shape, -sd, top, 3.8415, lowest, at) : lowest,
                         profile_end(evidence.shape, sd, top, 3.8415, highest, at)};
    evidence.parameters.push_back(
        {std::string(cause.parameters[1].name), {evidence.shape, place}, cause.parameters[1].unit(unit)});
  }
}

/// The time of a step at single samples: posterior under a flat prior, equal tails of 2.5 %.
void SlowSearch::place_step(Evidence& evidence) const {
  if (stop_.stop_requested()) {
    return;
  }
  const std::size_t r = evidence.members.front();
  const StudyRecording& recording = *group_.members[r].recording;
  const auto position = regressor_of(evidence);
  const double amplitude = null_.amplitude[static_cast<Eigen::Index>(position.value_or(0))];
  const auto start = static_cast<std::size_t>(std::max(0.0, std::ceil(evidence.shape / recording.dt_s - 1e-6)));
  // What lies hours away from the step says nothing of its time.
  constexpr std::size_t kMost = std::size_t{1} << 21U;
  const std::size_t count = std::min(recording.count(), kMost);
  const std::size_t middle = std::clamp(start, recording.begin + count / 2, recording.end - (count - count / 2));
  const std::size_t begin = middle - count / 2;
  const Series rest = residuals(error_)[r].part(begin - recording.begin, count);
  SingleRecording single = take_recording(series_, null_.model, r);
  single.series.block = 1;
  BlockRecording& samples = single.series.recordings[0];
  samples.first = begin;
  samples.start_s = recording.time_s(begin);
  samples.mean.assign(count, 0.0);
  samples.filled.resize(count);
  const Presence& valid = group_.members[r].channel->valid;
  for (std::size_t i = 0; i < count; ++i) {
    const bool masked = !mask_[r].empty() && mask_[r][begin + i] != 0;
    samples.filled[i] = valid[begin + i] != 0 && !masked ? 1.0 : 0.0;
  }
  BlockColumns columns = BlockColumns::zeros(single.series, 2);
  for (std::size_t i = 0; i < count; ++i) {
    columns.rows[0][2 * i] = rest[i] + (begin + i >= start ? amplitude : 0.0);
    columns.rows[0][2 * i + 1] = 1e-9;  // the bias is known from all recordings
  }
  const StepScan scan(single.series, single.model, columns, stop_);
  std::vector<double> gain = scan.steps_in(0).gain;
  // Only the neighbourhood of the block found: elsewhere another step would have been accepted.
  const double reach = 40.0 / recording.dt_s;
  double top = 0.0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (std::fabs(static_cast<double>(begin + i) - static_cast<double>(start)) > reach) {
      gain[i] = 0.0;
    }
    top = std::max(top, gain[i]);
  }
  double total = 0.0;
  for (const double g : gain) {
    total += g > 0.0 ? std::exp(0.5 * (g - top)) : 0.0;
  }
  double run = 0.0;
  std::size_t best = 0;
  std::size_t low = 0;
  std::size_t high = 0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    run += gain[i] > 0.0 ? std::exp(0.5 * (gain[i] - top)) : 0.0;
    low = run < 0.025 * total ? i + 1 : low;
    high = run < 0.975 * total ? i + 1 : high;
    best = gain[i] >= top ? i : best;
  }
  const auto time = [&](std::size_t i) { return recording.time_s(begin + i); };
  // A step between two samples is seen at the later one.
  evidence.parameters.push_back({std::string(evidence.cause->parameters[1].name),
                                 {time(best) - 0.5 * recording.dt_s, {time(low) - 1.01 * recording.dt_s, time(high)}},
                                 evidence.cause->parameters[1].unit(group_.unit)});
}

void SlowSearch::describe_slow(Evidence& evidence) const {
  const auto it = std::find(extra_cause_.begin(), extra_cause_.end(), evidence.cause);
  if (it == extra_cause_.end()) {
    return;
  }
  const std::size_t component = base_count_ + static_cast<std::size_t>(it - extra_cause_.begin());
  const SlowComponent& extra = null_.model.components[component];
  const BlockColumns columns = columns_with(accepted_);
  const Interval level = profile_parameter(series_, columns, null_, {component, false}, freedom());
  const Cause& cause = *evidence.cause;
  evidence.parameters = {{std::string(cause.parameters[0].name),
                          {extra.process.parameters[0], {std::sqrt(level.low), std::sqrt(level.high)}},
                          cause.parameters[0].unit(group_.unit)}};
  if (extra.kind().has_shape()) {
    const Interval beta = profile_parameter(series_, columns, null_, {component, true}, freedom());
    evidence.parameters.push_back({std::string(cause.parameters[1].name),
                                   {extra.process.only_shape(), beta},
                                   cause.parameters[1].unit(group_.unit)});
  }
}

}  // namespace driftlab::investigate
