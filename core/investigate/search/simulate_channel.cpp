#include "core/investigate/search/simulate_channel.hpp"

#include "core/investigate/causes/draft.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"
#include "core/process/linear_drift.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// What is slow is kept apart from what is new in each sample, and both from what has no density: effects on the noise
/// leave that alone.
void add_process(const Process& process, Draft& draft, Random& random) {
  const double dt_s = draft.recording->dt_s;
  const bool noise = process.kind->spectral_density(process.parameters, 0.25 / dt_s, dt_s).has_value();
  // A density that rises without limit towards frequency zero is that of a slow process too (power law).
  const bool rises = noise && process.kind->low_frequency == nullptr && process.kind->differenced_square == nullptr;
  std::vector<double>& part = process.kind->is_slow() || rises ? draft.slow : noise ? draft.white : draft.mean;
  process.add_path(random, dt_s, part);
}

/// Why an effect cannot act in the recording; empty: it can.
std::string obstacle(const GivenEffect& effect, const Draft& draft) {
  const Cause* const cause = find_cause(effect.cause);
  if (cause == nullptr) {
    return "there is no such cause";
  }
  if (effect.values.size() < cause->parameters.size()) {
    return "it lacks the parameter " + std::string(cause->parameters[effect.values.size()].name);
  }
  if (!effect.recordings.empty() &&
      std::find(effect.recordings.begin(), effect.recordings.end(), draft.recording->id) == effect.recordings.end()) {
    return "it belongs to single recordings";
  }
  std::vector<std::vector<double>> columns;
  const double shape = effect.values.size() > 1 ? effect.values[1] : 0.0;
  const MeanEffect* const mean = cause->as<MeanEffect>();
  if (mean != nullptr && cause->inject == nullptr && !mean->build(*draft.recording, *draft.group, shape, columns)) {
    return "it needs " + std::string(cause->needs);
  }
  const bool known = cause->is_slow() || cause->inject != nullptr;
  return known ? "" : "it cannot be simulated";
}

/// Puts a profile into the draft; why it cannot act there, empty: it does.
std::string add_unnamed(const UnnamedEffect& effect, Draft& draft) {
  const StudyRecording& recording = *draft.recording;
  if (!acts_on(effect, draft.group->column, recording.id)) {
    return "it belongs to single recordings";
  }
  if (effect.kind == UnnamedKind::Spectrum) {
    shape_spectrum(effect, recording.dt_s, draft.white);
    shape_spectrum(effect, recording.dt_s, draft.slow);
    return "";
  }
  const Series course = course_of(effect, recording, axis_index(draft.group->role.axis).value_or(2));
  if (course.empty()) {
    return "it needs " + std::string(words_of(effect.against));
  }
  for (std::size_t i = 0; i < recording.length; ++i) {
    const double value = value_at(effect, course[i]);
    if (effect.kind == UnnamedKind::Variance) {
      draft.white[i] *= std::sqrt(std::max(value, 0.0));
    } else {
      draft.mean[i] += value;
    }
  }
  return "";
}

}  // namespace

SimulatedChannel simulate_channel(const Baseline& model, StudyRecording recording, const std::string& column,
                                  const ColumnRole& role, std::uint64_t seed) {
  ChannelGroup group;
  group.column = column;
  group.role = role;
  group.unit = role.unit.value_or(Unit{});
  Random random(seed);
  Draft draft;
  draft.recording = &recording;
  draft.group = &group;
  draft.white.assign(recording.length, 0.0);
  draft.slow.assign(recording.length, 0.0);
  const auto term = [&](const std::map<std::string, double>& terms) {
    const auto found = terms.find(column);
    return found != terms.end() ? found->second : 0.0;
  };
  draft.mean.assign(recording.length, term(model.bias));
  add_process({&registered<LinearDrift>(), {term(model.drift)}}, draft, random);
  for (const Process& process : processes_of(model, group)) {
    add_process(process, draft, random);
  }
  draft.shared.resize(recording.length);
  for (double& v : draft.shared) {
    v = random.normal();
  }
  SimulatedChannel result;
  for (const GivenEffect& effect : model.effects) {
    const bool mine = effect.channels.empty() ||
                      std::find(effect.channels.begin(), effect.channels.end(), column) != effect.channels.end();
    if (!mine) {
      continue;
    }
    if (const std::string why = obstacle(effect, draft); !why.empty()) {
      result.left_out.push_back(effect.cause + ": " + why);
    } else {
      inject(*find_cause(effect.cause), draft, effect.values, random);
    }
  }
  for (const UnnamedEffect& effect : model.unnamed) {
    if (effect.column != column) {
      continue;
    }
    if (const std::string why = add_unnamed(effect, draft); !why.empty()) {
      result.left_out.push_back("a profile without a name: " + why);
    }
  }
  result.reading.resize(recording.length);
  const auto axis = axis_index(role.axis).value_or(2);
  const bool turns = role.quantity == Quantity::AngularRate && !recording.rate[axis].empty();
  for (std::size_t i = 0; i < recording.length; ++i) {
    result.reading[i] = draft.white[i] + draft.slow[i] + draft.mean[i] + (turns ? recording.rate[axis][i] : 0.0);
  }
  for (const auto& step : draft.output) {
    step(result.reading);
  }
  result.present = std::move(draft.present);
  result.stamp_error_s = std::move(draft.stamp_error_s);
  return result;
}

}  // namespace driftlab::investigate
