#include "core/investigate/search/given_model.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"
#include "core/process/constant_offset.hpp"
#include "core/process/quantization_noise.hpp"
#include "core/process/registry.hpp"
#include "core/process/white_noise.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

bool holds(const std::vector<std::string>& list, const std::string& name) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

/// Acts in every recording of the group.
bool everywhere(const GivenEffect& effect, const ChannelGroup& group) {
  return std::all_of(group.members.begin(), group.members.end(),
                     [&](const auto& member) { return holds(effect.recordings, member.recording->id); });
}

void add_process(const Process& process, SlowModel& model) {
  const ProcessKind& kind = *process.kind;
  if (kind.white_square != nullptr) {
    model.white += kind.white_square(process.parameters);
  } else if (kind.is_slow()) {
    model.components.push_back({process, {}});
  }
}

/// Every value within the interval of what was found.
bool agree(const std::vector<double>& values, const Evidence& evidence) {
  for (std::size_t k = 0; k < evidence.parameters.size() && k < values.size(); ++k) {
    const Interval& ci = evidence.parameters[k].estimate.ci95;
    // The model's own value is an estimate too, as uncertain as this one: twice the half width.
    const double middle = 0.5 * (ci.low + ci.high);
    const double reach = (ci.high - ci.low) + 1e-9 * std::fabs(middle);
    if (!(std::fabs(values[k] - middle) <= reach)) {
      return false;
    }
  }
  return true;
}

void add_slow_effect(const GivenEffect& effect, const ProcessKind& kind, const ChannelGroup& group, SlowModel& model) {
  SlowComponent component{{&kind, effect.values}, {}};
  if (!everywhere(effect, group)) {
    for (const auto& member : group.members) {
      component.in.push_back(holds(effect.recordings, member.recording->id) ? 1 : 0);
    }
  }
  model.components.push_back(std::move(component));
}

}  // namespace

bool applies(const Baseline& baseline, const ChannelGroup& group) {
  if (baseline.automatic) {
    return false;
  }
  if (!baseline.by_channel.empty()) {
    return baseline.by_channel.count(group.column) > 0;
  }
  return baseline.quantity == group.role.quantity && holds(baseline.channels, group.column);
}

const Model& processes_of(const Baseline& baseline, const ChannelGroup& group) {
  const auto own = baseline.by_channel.find(group.column);
  return own != baseline.by_channel.end() ? own->second : baseline.processes;
}

std::vector<const GivenEffect*> effects_on(const Baseline& baseline, const ChannelGroup& group) {
  std::vector<const GivenEffect*> effects;
  if (!applies(baseline, group)) {
    return effects;
  }
  for (const GivenEffect& effect : baseline.effects) {
    const bool meets = std::any_of(group.members.begin(), group.members.end(),
                                   [&](const auto& member) { return holds(effect.recordings, member.recording->id); });
    if (meets && holds(effect.channels, group.column) && !effect.values.empty() &&
        find_cause(effect.cause) != nullptr) {
      effects.push_back(&effect);
    }
  }
  return effects;
}

SlowModel given_model(const Baseline& baseline, const ChannelGroup& group) {
  SlowModel model;
  for (const Process& process : processes_of(baseline, group)) {
    add_process(process, model);
  }
  for (const GivenEffect* const effect : effects_on(baseline, group)) {
    const Cause& cause = *find_cause(effect->cause);
    const NoiseLevel* const level = cause.as<NoiseLevel>();
    if (const SlowNoise* const slow = cause.as<SlowNoise>()) {
      add_slow_effect(*effect, *slow->kind, group, model);
    } else if (level != nullptr && level->replaces_white && everywhere(*effect, group)) {
      model.white = effect->values[0] * effect->values[0];
    }
  }
  if (!(model.white > 0.0)) {
    model.white = 1e-12 * group.members.front().recording->dt_s;
  }
  return model;
}

double given_quantization(const Baseline& baseline, const ChannelGroup& group) {
  double sum = 0.0;
  for (const Process& process : processes_of(baseline, group)) {
    const auto law = process.kind->differenced_square;
    sum += law != nullptr ? law(process.parameters) : 0.0;
  }
  for (const GivenEffect* const effect : effects_on(baseline, group)) {
    if (find_cause(effect->cause)->as<DifferencedNoise>() != nullptr && everywhere(*effect, group)) {
      sum += effect->values[0] * effect->values[0];
    }
  }
  return sum;
}

namespace {

/// Takes the means off that a given model holds without a name.
void take_unnamed_means(const Baseline& baseline, const ChannelGroup& group, std::vector<Series>& error) {
  for (const UnnamedEffect& effect : baseline.unnamed) {
    for (std::size_t r = 0; r < error.size() && effect.kind == UnnamedKind::Mean; ++r) {
      const StudyRecording& recording = *group.members[r].recording;
      const Series course = course_of(effect, recording, group.axis());
      if (!acts_on(effect, group.column, recording.id) || course.empty()) {
        continue;
      }
      std::vector<double> rest = error[r].values();
      for (std::size_t i = 0; i < rest.size(); ++i) {
        rest[i] -= value_at(effect, course[i]);
      }
      error[r] = std::move(rest);
    }
  }
}

}  // namespace

void take_given_means(const Baseline& baseline, const ChannelGroup& group, std::vector<Series>& error) {
  double drift = 0.0;
  for (const Process& process : processes_of(baseline, group)) {
    const auto law = process.kind->slope;
    drift += law != nullptr ? law(process.parameters) : 0.0;
  }
  const auto own = baseline.drift.find(group.column);
  drift += own != baseline.drift.end() ? own->second : 0.0;
  for (std::size_t r = 0; r < error.size() && drift != 0.0; ++r) {
    std::vector<double> rest = error[r].values();
    for (std::size_t i = 0; i < rest.size(); ++i) {
      rest[i] -= drift * group.members[r].recording->time_s(i);
    }
    error[r] = std::move(rest);
  }
  for (const GivenEffect* const effect : effects_on(baseline, group)) {
    const MeanEffect* const mean = find_cause(effect->cause)->as<MeanEffect>();
    if (mean == nullptr || mean->free_phase) {
      continue;
    }
    const double shape = effect->values.size() > 1 ? effect->values[1] : 0.0;
    for (std::size_t r = 0; r < error.size(); ++r) {
      std::vector<std::vector<double>> columns;
      const StudyRecording& recording = *group.members[r].recording;
      if (!holds(effect->recordings, recording.id) || !mean->build(recording, group, shape, columns)) {
        continue;
      }
      std::vector<double> rest = error[r].values();
      for (std::size_t i = 0; i < rest.size(); ++i) {
        rest[i] -= effect->values[0] * columns[0][i];
      }
      error[r] = std::move(rest);
    }
  }
  take_unnamed_means(baseline, group, error);
}

bool confirmed(const Baseline& baseline, const ChannelGroup& group, const Evidence& evidence) {
  for (const GivenEffect* const effect : effects_on(baseline, group)) {
    const bool meets = std::any_of(evidence.members.begin(), evidence.members.end(), [&](std::size_t r) {
      return r < group.members.size() && holds(effect->recordings, group.members[r].recording->id);
    });
    if (effect->cause == evidence.cause->name && meets && agree(effect->values, evidence)) {
      return true;
    }
  }
  if (!applies(baseline, group)) {
    return false;
  }
  const Model& processes = processes_of(baseline, group);
  return std::any_of(processes.begin(), processes.end(), [&](const Process& process) {
    return !process.kind->can_be_taken_out() && process.kind->name == evidence.cause->process &&
           agree(process.parameters, evidence);
  });
}

Status check_processes(const Baseline& baseline) {
  const auto check = [](const Model& processes) -> Status {
    for (const Process& process : processes) {
      const auto names = [&](const Cause& cause) { return cause.process == process.kind->name; };
      if (!process.kind->can_be_taken_out() && std::none_of(cause_registry().begin(), cause_registry().end(), names)) {
        return fail(ErrorCode::InvalidArgument,
                    "The baseline holds the process " + std::string(process.kind->name) +
                        ", which an investigation can neither take out of a recording nor find again in it.",
                    {{"parameter", "baseline"}, {"value", std::string(process.kind->name)}});
      }
    }
    return {};
  };
  Status status = check(baseline.processes);
  for (auto own = baseline.by_channel.begin(); status && own != baseline.by_channel.end(); ++own) {
    status = check(own->second);
  }
  return status;
}

Model noise_processes(const ChannelModel& model, const ChannelBase& base) {
  if (model.given) {
    return model.given_processes;
  }
  Model list{{&registered<WhiteNoise>(), {std::sqrt(base.noise.white)}}};
  if (base.quantization > 0.0) {
    list.push_back({&registered<QuantizationNoise>(), {std::sqrt(base.quantization)}});
  }
  for (const SlowComponent& component : base.noise.components) {
    if (component.process.kind != &constant_offset()) {
      list.push_back(component.process);
    }
  }
  return list;
}

}  // namespace driftlab::investigate
