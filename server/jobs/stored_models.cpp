#include "server/jobs/stored_models.hpp"

#include "core/analysis/table_schedule.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/imu_model.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/stored_table.hpp"

namespace driftlab::server {
namespace {

/// Puts the processes of a stored fit in the place of its id.
Status resolve_fit(Json& node, const std::string& pointer, Store& store, Faults& faults) {
  auto fit = store.fit(node["fit"].get<std::string>());
  if (!fit && fit.error().code != ErrorCode::NotFound) {
    return fail(fit.error());
  }
  auto document = fit ? parse_json(fit->document_json) : Result<Json>(Json::object());
  if (!fit || !document || !document->contains("processes")) {
    faults.add(pointer + "/fit", ErrorCode::NotFound, "There is no fit " + node["fit"].get<std::string>() + ".");
    return {};
  }
  node.erase("fit");
  node["processes"] = (*document)["processes"];
  for (Json& process : node["processes"]) {
    process.erase("reasons");
  }
  return {};
}

/// Puts the models of a device's parameter table in the place of the table's query.
Status resolve_table(Json& node, const std::string& pointer, Store& store, Faults& faults) {
  ObjectReader reader(node["table"], pointer + "/table", faults);
  StoredTableRequest wanted;
  wanted.device = reader.required_text("device");
  wanted.axis = reader.text("axis").value_or("");
  wanted.method = reader.text("method").value_or(wanted.method);
  wanted.model = reader.text("model").value_or("");
  const std::string schedule = reader.text("schedule").value_or("switched");
  TableScheduleOptions options;
  options.continuous = schedule == "continuous";
  options.hysteresis_rad_s = reader.real("hysteresis_deg_s").value_or(0.0) * kDegree;
  options.step_rad_s = reader.real("step_deg_s").value_or(1.0) * kDegree;
  reader.reject_unknown();
  if (!options.continuous && schedule != "switched") {
    faults.add(pointer + "/table/schedule", ErrorCode::InvalidArgument, "A schedule is switched or continuous.");
  }
  if (!faults.none()) {
    return {};
  }
  auto table = stored_table(store, wanted);
  if (!table) {
    faults.add(pointer + "/table", table.error());
    return {};
  }
  if (table->pooling.state == PoolingState::Pending) {
    // An evaluation is kept for good: it must not depend on whether it was asked for before or after the joint fit.
    return fail(ErrorCode::Conflict,
                "The results behind the table of device '" + wanted.device + "' are being pooled by job " +
                    table->pooling.job + "; ask again when it has ended.",
                {{std::string(kPendingPool), table->pooling.job}});
  }
  const auto made = schedule_from_table(table->table, options);
  if (!made) {
    faults.add(pointer + "/table", made.error());
    return {};
  }
  node.erase("table");
  node.update(schedule_to_json(*made, Dimension::AngularRate));
  return {};
}

Status resolve_within(Json& node, const std::string& pointer, Store& store, StoredSensors& sensors, Faults& faults,
                      int depth) {
  if (!node.is_structured() || depth > kMaxJsonDepth) {
    return {};
  }
  if (node.is_object() && node.contains("simulation_model")) {
    return resolve_simulation_model(node, pointer, store, sensors, faults);
  }
  if (node.is_object() && node.contains("fit") && node["fit"].is_string()) {
    return resolve_fit(node, pointer, store, faults);
  }
  if (node.is_object() && node.contains("table") && node["table"].is_object()) {
    return resolve_table(node, pointer, store, faults);
  }
  for (const auto& [name, child] : node.items()) {  // of an array the names are the indices
    std::string where = pointer;
    where.append("/").append(name);
    if (auto status = resolve_within(child, where, store, sensors, faults, depth + 1); !status) {
      return status;
    }
  }
  return {};
}

}  // namespace

Status resolve_stored(Json& node, const std::string& pointer, Store& store, StoredSensors& sensors, Faults& faults) {
  return resolve_within(node, pointer, store, sensors, faults, 0);
}

}  // namespace driftlab::server
