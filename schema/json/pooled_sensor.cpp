#include "schema/json/pooled_sensor.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

#include <limits>

namespace driftlab {
namespace {

constexpr double kNotFinite = std::numeric_limits<double>::quiet_NaN();

Json condition_to_json(const PooledCondition& entry) {
  Json fits = Json::array();
  for (const ReportedFit& fit : entry.fits) {
    fits.push_back(to_json(fit));
  }
  Json document{{"condition", to_json(entry.condition)},
                {"key", entry.key},
                {"label", label(entry.condition)},
                {"recordings", entry.recordings},
                {"members", entry.members},
                {"contamination", text_or_null(entry.contamination)},
                {"robust", entry.robust},
                {"agreement", to_json(entry.agreement)},
                {"best", fits.empty() ? Json(nullptr) : Json(0)},
                {"fits", std::move(fits)}};
  if (!entry.reason.empty()) {
    document["reason"] = entry.reason;
  }
  return document;
}

PooledCondition condition_entry_from_json(const Json& document) {
  PooledCondition entry;
  Faults ignored;
  entry.condition = condition_from_json(document.at("condition"), "", ignored);
  entry.key = document.at("key").get<std::string>();
  entry.recordings = document.at("recordings").get<std::vector<std::string>>();
  entry.members = document.at("members").get<std::vector<std::string>>();
  entry.contamination = text_member(document, "contamination");
  entry.robust = document.value("robust", false);
  if (const Json& agreement = document.at("agreement"); agreement.is_object()) {
    entry.agreement =
        RecordingAgreement{text_member(agreement, "model"), finite_member(agreement, "statistic", kNotFinite),
                           finite_member(agreement, "dof", kNotFinite), finite_member(agreement, "p", kNotFinite)};
  }
  entry.fits = fits_from_json(document.at("fits"));
  entry.reason = text_member(document, "reason");
  return entry;
}

PooledStructure structure_from_json(const Json& document) {
  PooledStructure structure;
  structure.verdict = document.at("verdict").get<std::string>();
  structure.statement = document.at("statement").get<std::string>();
  structure.p = finite_member(document, "p", kNotFinite);
  structure.statistic = finite_member(document, "statistic", kNotFinite);
  structure.dof = finite_member(document, "dof", kNotFinite);
  structure.common = document.at("common").get<std::string>();
  structure.excess = finite_member(document, "excess", kNotFinite);
  for (const Json& ranked : document.at("ranking")) {
    structure.ranking.push_back(
        {ranked.at("model").get<std::string>(), finite_member(ranked, "criterion", kNotFinite)});
  }
  for (const Json& one : document.at("by_condition")) {
    structure.by_condition.push_back({one.at("label").get<std::string>(), one.at("model").get<std::string>()});
  }
  return structure;
}

PooledSensor sensor_from_json(const Json& document) {
  PooledSensor pooled;
  pooled.quantity = text_member(document, "quantity");
  pooled.axis = text_member(document, "axis");
  pooled.channel = text_member(document, "channel");
  pooled.sensor_axis = text_member(document, "sensor_axis");
  pooled.model = text_member(document, "model");
  if (const Json& structure = document.at("structure"); structure.is_object()) {
    pooled.structure = structure_from_json(structure);
  }
  for (const Json& entry : document.at("conditions")) {
    pooled.conditions.push_back(condition_entry_from_json(entry));
  }
  pooled.reason = text_member(document, "reason");
  return pooled;
}

}  // namespace

Json to_json(const std::optional<RecordingAgreement>& agreement) {
  if (!agreement) {
    return nullptr;
  }
  const bool joint = !agreement->model.empty();
  return Json{{"model", text_or_null(agreement->model)},
              {"statistic", number(agreement->statistic)},
              {"dof", joint ? number(agreement->dof) : Json(static_cast<long>(agreement->dof))},
              {"p", number(agreement->p)},
              {"agree", agreement->agree()}};
}

Json to_json(const PooledStructure& structure) {
  Json ranking = Json::array();
  for (const RankedStructure& ranked : structure.ranking) {
    ranking.push_back(Json{{"model", ranked.model}, {"criterion", number(ranked.criterion)}});
  }
  Json by_condition = Json::array();
  for (const ConditionStructure& one : structure.by_condition) {
    by_condition.push_back(Json{{"label", one.label}, {"model", one.model}});
  }
  return Json{{"verdict", structure.verdict},
              {"statement", structure.statement},
              {"p", number(structure.p)},
              {"statistic", number(structure.statistic)},
              {"dof", number(structure.dof)},
              {"common", structure.common},
              {"excess", number(structure.excess)},
              {"ranking", std::move(ranking)},
              {"by_condition", std::move(by_condition)}};
}

Json to_json(const PooledSensor& pooled) {
  Json conditions = Json::array();
  for (const PooledCondition& entry : pooled.conditions) {
    conditions.push_back(condition_to_json(entry));
  }
  Json document{{"quantity", text_or_null(pooled.quantity)}, {"axis", text_or_null(pooled.axis)}};
  if (!pooled.channel.empty()) {
    document["channel"] = pooled.channel;
  }
  document["model"] = text_or_null(pooled.model);
  document["structure"] = pooled.structure ? to_json(*pooled.structure) : Json(nullptr);
  document["conditions"] = std::move(conditions);
  if (!pooled.reason.empty()) {
    document["reason"] = pooled.reason;
  }
  if (!pooled.sensor_axis.empty()) {
    document["sensor_axis"] = pooled.sensor_axis;
  }
  return document;
}

Result<PooledSensor> pooled_sensor_from_json(const Json& document) {
  try {
    return sensor_from_json(document);
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A stored joint fit cannot be read: " + std::string(fault.what()) + ".");
  }
}

}  // namespace driftlab
