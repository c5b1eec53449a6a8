#include "schema/json/pooled_sensor.hpp"

#include "core/fit/replicates.hpp"
#include "core/fit/structure.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/table_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

namespace driftlab {
namespace {

constexpr double kSize = 0.05;

/// One condition on its way into the document.
struct Group {
  Condition condition;
  std::string text;
  std::vector<const TableSource*> sources;
  Unit unit;
  bool robust = false;
  std::unique_ptr<Replicates> stack;
  std::map<std::string, Candidate> joint;  ///< by model; refers to `stack`
  std::map<std::string, Json> fits;        ///< by model, what is known without fitting again
  std::map<std::string, StructureScore> scores;
  Json agreement;  ///< taken over, with the model it is of
};

bool contaminated(const Json& channel) {
  const auto found = channel.find("contamination");
  return found != channel.end() && found->value("verdict", "") == "contaminated";
}

std::vector<std::string> members_of(const Group& group) {
  std::vector<std::string> members;
  members.reserve(group.sources.size());
  for (const TableSource* source : group.sources) {
    members.push_back(source->result_id.empty() ? source->recording_id : source->result_id);
  }
  std::sort(members.begin(), members.end());
  return members;
}

/// The stored curve in SI. Robust values, where they exist, for a contaminated channel.
WaveletRecord record_of(const Json& channel, double factor) {
  WaveletRecord record;
  record.samples = channel.at("samples").get<std::size_t>() + channel.value("missing", std::size_t{0});
  record.dt_s = channel.at("dt_s").get<double>();
  const Json& haar = channel.at("haar");
  const bool robust = contaminated(channel) && haar.contains("robust");
  const Json& variances = robust ? haar["robust"]["variance"] : haar.at("variance");
  const Json efficiencies = (robust ? haar["robust"] : haar).value("efficiency_by_scale", Json());
  for (std::size_t j = 0; j < haar.at("scale").size(); ++j) {
    const double value = variances[j].is_number() ? variances[j].get<double>() : 0.0;
    const bool known = efficiencies.is_array() && efficiencies[j].is_number();
    const double efficiency = known ? efficiencies[j].get<double>() : 1.0;
    record.half.push_back(haar["scale"][j].get<std::size_t>() / 2);
    record.variance.push_back(value * factor * factor);
    record.inflation.push_back(efficiency > 0.0 ? 1.0 / efficiency : 1.0);
  }
  return record;
}

Result<std::vector<Group>> group_by_condition(const std::vector<TableSource>& sources) {
  std::vector<Group> groups;
  for (const TableSource& source : sources) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.text == source.condition; });
    if (group == groups.end()) {
      Group made;
      made.text = source.condition;
      made.condition = parse_condition(source.condition).value_or(Condition{});
      made.unit = parse_unit(source.channel.value("unit", "1")).value_or(Unit{});
      groups.push_back(std::move(made));
      group = groups.end() - 1;
    }
    const Unit unit = parse_unit(source.channel.value("unit", "1")).value_or(Unit{});
    if (unit.dimension != groups.front().unit.dimension) {
      return fail(ErrorCode::InvalidArgument,
                  "The channels of this axis are in units that do not convert into each other, " +
                      groups.front().unit.symbol + " and " + unit.symbol + ".");
    }
    group->sources.push_back(&source);
    group->robust = group->robust || contaminated(source.channel);
  }
  std::sort(groups.begin(), groups.end(),
            [](const Group& a, const Group& b) { return comes_before(a.condition, b.condition); });
  return groups;
}

/// Names of the models that every source was fitted with, smaller ones first.
std::vector<std::string> common_models(const std::vector<TableSource>& sources) {
  std::vector<std::string> names;
  for (const Json& fit : sources.front().channel.at("fits")) {
    const std::string name = fit.value("model", "");
    const bool everywhere = std::all_of(sources.begin(), sources.end(), [&](const TableSource& source) {
      return find_fit(source.channel, name) != nullptr;
    });
    if (everywhere && parse_model(name)) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    const auto key = [](const std::string& name) { return std::pair(parse_model(name)->parameter_count(), name); };
    return key(a) < key(b);
  });
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

StructureScore score_of(const Json& fit) {
  StructureScore score;
  if (!fit.value("wic", Json()).is_number()) {
    return score;
  }
  score.fitted = true;
  score.criterion = fit["wic"].get<double>();
  if (const Json& test = fit["j_test"]; test.is_object()) {
    score.misfit = test["statistic"].is_number() ? test["statistic"].get<double>() : 0.0;
    score.dof = test["dof"].is_number() ? test["dof"].get<double>() : 0.0;
  }
  return score;
}

Status stack_group(Group& group) {
  if (group.stack) {
    return {};
  }
  std::vector<WaveletRecord> records;
  for (const TableSource* source : group.sources) {
    const Unit unit = parse_unit(source->channel.value("unit", "1")).value_or(Unit{});
    records.push_back(record_of(source->channel, unit.factor));
  }
  auto stack = Replicates::stack(records);
  if (!stack) {
    return fail(stack.error());
  }
  group.stack = std::make_unique<Replicates>(*std::move(stack));
  return {};
}

/// The joint fit of one model; nullptr where it has no component.
Candidate* joint_fit(Group& group, const std::string& model) {
  if (!stack_group(group)) {
    return nullptr;
  }
  auto found = group.joint.find(model);
  if (found == group.joint.end()) {
    found = group.joint.emplace(model, group.stack->fit(*parse_model(model))).first;
  }
  return found->second.log_fit == nullptr ? nullptr : &found->second;
}

Json joint_fit_json(Group& group, Candidate& joint, IntervalMethod method) {
  ModelFit fit = group.stack->report(joint, method);
  fit.robust = group.robust;
  Json document = to_json(fit, group.unit);
  document["intervals"] = method == IntervalMethod::Profile ? "profile" : "sandwich";
  return document;
}

/// Fills fits and scores of a group: from the previous document, from the one recording's own fits, or by joint fits.
void fit_group(Group& group, const std::vector<std::string>& models, std::span<const Json> previous) {
  const Json* known = nullptr;
  for (auto older = previous.begin(); older != previous.end() && known == nullptr; ++older) {
    known = find_pooled(&*older, group.text, members_of(group));
  }
  if (known != nullptr) {
    for (const Json& fit : known->at("fits")) {
      group.fits[fit.value("model", "")] = fit;
    }
    group.agreement = known->value("agreement", Json());
  } else if (group.sources.size() == 1 && !group.robust) {
    const Json& channel = group.sources.front()->channel;
    for (const Json& fit : channel.at("fits")) {
      Json taken = fit;
      taken["intervals"] = &fit == &channel["fits"].front() ? "profile" : "sandwich";
      group.fits.emplace(fit.value("model", ""), std::move(taken));
    }
  }
  for (const std::string& model : models) {
    auto fit = group.fits.find(model);
    if (fit == group.fits.end()) {
      Candidate* const joint = joint_fit(group, model);
      if (joint == nullptr || parse_model(model)->parameter_count() > group.stack->rows()) {
        continue;
      }
      fit = group.fits.emplace(model, joint_fit_json(group, *joint, IntervalMethod::Preview)).first;
    }
    group.scores[model] = score_of(fit->second);
  }
}

void sharpen(Group& group, const std::string& model) {
  const auto fit = group.fits.find(model);
  if (fit == group.fits.end() || fit->second.value("intervals", "") == "profile") {
    return;
  }
  if (Candidate* const joint = joint_fit(group, model)) {
    fit->second = joint_fit_json(group, *joint, IntervalMethod::Profile);
  }
}

Json agreement_json(Group& group, const std::string& model) {
  if (group.sources.size() < 2 || model.empty()) {
    return nullptr;
  }
  if (group.agreement.is_object() && group.agreement.value("model", "") == model) {
    return group.agreement;
  }
  Candidate* const joint = joint_fit(group, model);
  const auto agreement = joint != nullptr ? group.stack->agreement(*joint) : std::nullopt;
  if (!agreement) {
    return nullptr;
  }
  return Json{{"model", model},
              {"statistic", number(agreement->statistic)},
              {"dof", number(agreement->dof)},
              {"p", number(agreement->p)},
              {"agree", agreement->p >= kSize}};
}

std::string worst_verdict(const Group& group) {
  std::string worst;
  const auto badness = [](const std::string& v) {
    return v == "contaminated" ? 3 : v == "undecided" ? 2 : v.empty() ? 0 : 1;
  };
  for (const TableSource* source : group.sources) {
    const auto found = source->channel.find("contamination");
    const std::string verdict = found == source->channel.end() ? "" : found->value("verdict", "");
    worst = badness(verdict) > badness(worst) ? verdict : worst;
  }
  return worst;
}

Json group_json(Group& group, const std::string& model) {
  Json recordings = Json::array();
  for (const TableSource* source : group.sources) {
    recordings.push_back(source->recording_id);
  }
  Json agreement = agreement_json(group, model);
  std::vector<const Json*> order;
  for (const auto& [name, fit] : group.fits) {
    order.push_back(&fit);
  }
  std::sort(order.begin(), order.end(), [](const Json* a, const Json* b) {
    const auto key = [](const Json& fit) {
      return std::pair(fit["wic"].is_number() ? fit["wic"].get<double>() : HUGE_VAL, fit["model"].get<std::string>());
    };
    return key(*a) < key(*b);
  });
  Json fits = Json::array();
  for (const Json* fit : order) {
    fits.push_back(*fit);
  }
  const std::string verdict = worst_verdict(group);
  return Json{{"condition", to_json(group.condition)},
              {"key", group.text},
              {"label", label(group.condition)},
              {"recordings", std::move(recordings)},
              {"members", members_of(group)},
              {"contamination", verdict.empty() ? Json(nullptr) : Json(verdict)},
              {"robust", group.robust},
              {"agreement", std::move(agreement)},
              {"best", fits.empty() ? Json(nullptr) : Json(0)},
              {"fits", std::move(fits)}};
}

Json structure_json(const StructureChoice& choice, const std::vector<std::string>& models,
                    const std::vector<Group>& groups) {
  std::vector<std::size_t> order(models.size());
  for (std::size_t s = 0; s < order.size(); ++s) {
    order[s] = s;
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(choice.sum[a], a) < std::pair(choice.sum[b], b); });
  Json ranking = Json::array();
  for (const std::size_t s : order) {
    ranking.push_back(Json{{"model", models[s]}, {"criterion", number(choice.sum[s])}});
  }
  Json by_condition = Json::array();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    by_condition.push_back(Json{{"label", label(groups[g].condition)}, {"model", models[choice.by_condition[g]]}});
  }
  return Json{{"verdict", name_of(choice.verdict)},
              {"statement", choice.statement},
              {"p", number(choice.p)},
              {"statistic", number(choice.statistic)},
              {"dof", number(choice.dof)},
              {"common", models[choice.common]},
              {"excess", number(choice.excess)},
              {"ranking", std::move(ranking)},
              {"by_condition", std::move(by_condition)}};
}

}  // namespace

const Json* find_pooled(const Json* pooled, const std::string& condition, std::vector<std::string> members) {
  if (pooled == nullptr || !pooled->is_object() || !pooled->contains("conditions")) {
    return nullptr;
  }
  std::sort(members.begin(), members.end());
  for (const Json& entry : (*pooled)["conditions"]) {
    if (entry.value("key", "") == condition && entry["members"] == Json(members)) {
      return &entry;
    }
  }
  return nullptr;
}

Result<Json> pool_sensor(const std::vector<TableSource>& sources, std::span<const Json> previous,
                         const RunControl& control) {
  if (sources.empty()) {
    return fail(ErrorCode::InvalidArgument, "There are no results to put together.");
  }
  auto groups = group_by_condition(sources);
  if (!groups) {
    return fail(groups.error());
  }
  const std::vector<std::string> models = common_models(sources);
  std::vector<std::vector<StructureScore>> scores;
  for (Group& group : *groups) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Putting the recordings together was cancelled.");
    }
    control.report("joint fit: " + label(group.condition),
                   static_cast<double>(scores.size()) / static_cast<double>(groups->size()));
    fit_group(group, models, previous);
    std::vector<StructureScore> row;
    for (const std::string& model : models) {
      row.push_back(group.scores[model]);
    }
    scores.push_back(std::move(row));
  }
  Json structure;
  std::string model;
  if (!models.empty()) {
    const StructureChoice choice = choose_structure(models, scores);
    model = std::isfinite(choice.sum[choice.best]) ? models[choice.best] : "";
    structure = structure_json(choice, models, *groups);
    for (std::size_t g = 0; g < groups->size(); ++g) {
      sharpen((*groups)[g], models[choice.by_condition[g]]);
      sharpen((*groups)[g], model);
    }
  }
  Json conditions = Json::array();
  for (Group& group : *groups) {
    conditions.push_back(group_json(group, model));
  }
  const Json& first = sources.front().channel;
  return Json{{"quantity", first.value("quantity", Json())}, {"axis", first.value("axis", Json())},
              {"channel", first.value("channel", Json())},   {"model", model.empty() ? Json(nullptr) : Json(model)},
              {"structure", std::move(structure)},           {"conditions", std::move(conditions)}};
}

}  // namespace driftlab
