#include "core/campaign/pooled_sensor.hpp"

#include "core/campaign/replicates.hpp"
#include "core/campaign/told_structure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace driftlab {
namespace {

/// One condition on its way into the result.
struct ReplicateGroup {
  PooledCondition told;
  std::vector<const TableSource*> sources;
  Unit unit;
  std::unique_ptr<Replicates> stack;
  std::map<std::string, Candidate> joint;   ///< by model; refers to `stack`
  std::map<std::string, ReportedFit> fits;  ///< by model, what is known without fitting again
  std::map<std::string, StructureScore> scores;
};

tl::unexpected<Error> cancelled() {
  return fail(ErrorCode::Cancelled, "Putting the recordings together was cancelled.");
}

std::vector<ReplicateGroup> group_by_condition(const std::vector<TableSource>& sources) {
  std::vector<ReplicateGroup> groups;
  for (const TableSource& source : sources) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const ReplicateGroup& g) { return g.told.key == source.condition; });
    if (group == groups.end()) {
      ReplicateGroup made;
      made.told.key = source.condition;
      made.told.condition = parse_condition(source.condition).value_or(Condition{});
      made.unit = source.channel.parsed_unit();
      groups.push_back(std::move(made));
      group = groups.end() - 1;
    }
    group->sources.push_back(&source);
    PooledCondition& told = group->told;
    told.recordings.push_back(source.recording_id);
    told.members.push_back(source.member_id());
    told.robust = told.robust || source.channel.contaminated();
    told.contamination = worse_verdict(told.contamination, source.channel.contamination);
  }
  for (ReplicateGroup& group : groups) {
    std::sort(group.told.members.begin(), group.told.members.end());
  }
  std::sort(groups.begin(), groups.end(), [](const ReplicateGroup& a, const ReplicateGroup& b) {
    return comes_before(a.told.condition, b.told.condition);
  });
  return groups;
}

std::vector<std::string> common_models(const std::vector<TableSource>& sources) {
  std::vector<const std::vector<ReportedFit>*> rows;
  for (const TableSource& source : sources) {
    rows.push_back(&source.channel.fits);
  }
  return shared_models(rows);
}

/// Stacks the recordings, or notes in `reason` that one of them has too few variances. Error: InvalidArgument.
Status stack_group(ReplicateGroup& group) {
  if (group.stack || !group.told.reason.empty()) {
    return {};
  }
  std::vector<WaveletRecord> records;
  for (const TableSource* source : group.sources) {
    records.push_back(record_of(source->channel));
  }
  auto stack = Replicates::stack(records);
  if (stack) {
    group.stack = std::make_unique<Replicates>(*std::move(stack));
    return {};
  }
  if (stack.error().code == ErrorCode::TooFewSamples) {
    group.told.reason = stack.error().message;
    return {};
  }
  return fail(stack.error());
}

/// The joint fit of one model; nullptr where it has no component, or where there is nothing to fit.
Result<Candidate*> joint_fit(ReplicateGroup& group, const std::string& model) {
  if (auto stacked = stack_group(group); !stacked) {
    return fail(stacked.error());
  }
  if (!group.stack) {
    return nullptr;
  }
  auto found = group.joint.find(model);
  if (found == group.joint.end()) {
    found = group.joint.emplace(model, group.stack->fit(*parse_model(model))).first;
  }
  return found->second.log_fit == nullptr ? nullptr : &found->second;
}

ReportedFit report_joint(const ReplicateGroup& group, Candidate& joint, IntervalMethod method) {
  ModelFit fit = group.stack->report(joint, method);
  fit.robust = group.told.robust;
  fit.intervals = method == IntervalMethod::Profile ? "profile" : "sandwich";
  return reported(fit, group.unit);
}

/// What is known without a joint fit: from an earlier result, or from the one recording's own fits.
void take_known_fits(ReplicateGroup& group, std::span<const PooledSensor> previous) {
  const PooledCondition* known = nullptr;
  for (auto older = previous.begin(); older != previous.end() && known == nullptr; ++older) {
    known = find_pooled(&*older, group.told.key, group.told.members);
  }
  if (known != nullptr) {
    for (const ReportedFit& fit : known->fits) {
      group.fits[fit.model] = fit;
    }
    group.told.agreement = known->agreement;
  } else if (group.sources.size() == 1 && !group.told.robust) {
    const std::vector<ReportedFit>& own = group.sources.front()->channel.fits;
    for (const ReportedFit& fit : own) {
      ReportedFit taken = fit;
      taken.intervals = &fit == &own.front() ? "profile" : "sandwich";
      group.fits.emplace(fit.model, std::move(taken));
    }
  }
}

/// Fills fits and scores of a group: what is known, and joint fits of the rest.
Status fit_group(ReplicateGroup& group, const std::vector<std::string>& models, std::span<const PooledSensor> previous,
                 const RunControl& control) {
  take_known_fits(group, previous);
  for (const std::string& model : models) {
    if (control.stop.stop_requested()) {
      return cancelled();
    }
    auto fit = group.fits.find(model);
    if (fit == group.fits.end()) {
      auto joint = joint_fit(group, model);
      if (!joint) {
        return fail(joint.error());
      }
      if (*joint == nullptr || parse_model(model)->parameter_count() > group.stack->rows()) {
        continue;
      }
      fit = group.fits.emplace(model, report_joint(group, **joint, IntervalMethod::Preview)).first;
    }
    group.scores[model] = score_of(fit->second);
  }
  return {};
}

Status sharpen(ReplicateGroup& group, const std::string& model) {
  const auto fit = group.fits.find(model);
  if (fit == group.fits.end() || fit->second.intervals == "profile") {
    return {};
  }
  auto joint = joint_fit(group, model);
  if (!joint) {
    return fail(joint.error());
  }
  if (*joint != nullptr) {
    fit->second = report_joint(group, **joint, IntervalMethod::Profile);
  }
  return {};
}

/// Of the common model; one that was taken over stays where it is of that model.
Status note_agreement(ReplicateGroup& group, const std::string& model) {
  std::optional<RecordingAgreement>& agreement = group.told.agreement;
  if (group.sources.size() < 2 || model.empty()) {
    agreement.reset();
    return {};
  }
  if (agreement && agreement->model == model) {
    return {};
  }
  agreement.reset();
  auto joint = joint_fit(group, model);
  if (!joint) {
    return fail(joint.error());
  }
  if (const auto found = *joint != nullptr ? group.stack->agreement(**joint) : std::nullopt) {
    agreement = RecordingAgreement{model, found->statistic, found->dof, found->p};
  }
  return {};
}

/// The finished entry of a group.
PooledCondition conclude(ReplicateGroup& group) {
  std::vector<ReportedFit> fits;
  for (auto& [model, fit] : group.fits) {
    fits.push_back(std::move(fit));
  }
  std::sort(fits.begin(), fits.end(), [](const ReportedFit& a, const ReportedFit& b) {
    const auto key = [](const ReportedFit& fit) {
      return std::pair(std::isfinite(fit.wic) ? fit.wic : HUGE_VAL, fit.model);
    };
    return key(a) < key(b);
  });
  group.told.fits = std::move(fits);
  return std::move(group.told);
}

/// Ranks the structures over all conditions, and gives the fits that are shown their profile intervals.
Status choose_model(std::vector<ReplicateGroup>& groups, const std::vector<std::string>& models, PooledSensor& pooled,
                    const RunControl& control) {
  if (models.empty()) {
    return {};
  }
  std::vector<std::vector<StructureScore>> scores;
  for (ReplicateGroup& group : groups) {
    std::vector<StructureScore> row;
    for (const std::string& model : models) {
      row.push_back(group.scores[model]);
    }
    scores.push_back(std::move(row));
  }
  const StructureChoice choice = choose_structure(models, scores);
  pooled.model = std::isfinite(choice.sum[choice.best]) ? models[choice.best] : "";
  std::vector<std::string> labels;
  for (const ReplicateGroup& group : groups) {
    labels.push_back(label(group.told.condition));
  }
  pooled.structure = told_structure(choice, models, labels);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const std::string& model : {models[choice.by_condition[g]], pooled.model}) {
      if (control.stop.stop_requested()) {
        return cancelled();
      }
      if (auto sharpened = sharpen(groups[g], model); !sharpened) {
        return sharpened;
      }
    }
  }
  return {};
}

}  // namespace

const PooledCondition* find_pooled(const PooledSensor* pooled, const std::string& condition,
                                   std::vector<std::string> members) {
  if (pooled == nullptr) {
    return nullptr;
  }
  std::sort(members.begin(), members.end());
  const auto found =
      std::find_if(pooled->conditions.begin(), pooled->conditions.end(),
                   [&](const PooledCondition& entry) { return entry.key == condition && entry.members == members; });
  return found == pooled->conditions.end() ? nullptr : &*found;
}

Result<PooledSensor> pool_sensor(const std::vector<TableSource>& sources, std::span<const PooledSensor> previous,
                                 const RunControl& control) {
  if (sources.empty()) {
    return fail(ErrorCode::InvalidArgument, "There are no results to put together.");
  }
  const ReportedChannel& first = sources.front().channel;
  PooledSensor pooled;
  pooled.quantity = first.quantity;
  pooled.reason = unit_conflict(sources);
  if (!pooled.reason.empty()) {
    return pooled;
  }
  pooled.axis = first.axis;
  pooled.channel = first.channel;
  std::vector<ReplicateGroup> groups = group_by_condition(sources);
  const std::vector<std::string> models = common_models(sources);
  std::size_t done = 0;
  for (ReplicateGroup& group : groups) {
    if (control.stop.stop_requested()) {
      return cancelled();
    }
    control.report("joint fit: " + label(group.told.condition),
                   static_cast<double>(done++) / static_cast<double>(groups.size()));
    if (auto fitted = fit_group(group, models, previous, control); !fitted) {
      return fail(fitted.error());
    }
  }
  if (auto chosen = choose_model(groups, models, pooled, control); !chosen) {
    return fail(chosen.error());
  }
  for (ReplicateGroup& group : groups) {
    if (auto noted = note_agreement(group, pooled.model); !noted) {
      return fail(noted.error());
    }
    pooled.conditions.push_back(conclude(group));
  }
  return pooled;
}

}  // namespace driftlab
