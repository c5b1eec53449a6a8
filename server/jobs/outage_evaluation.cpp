/// The job kind `outage_evaluation`: filters compared through simulated GNSS outages
/// (core/navigate/outage_evaluation.hpp).
///
/// `inputs`: {"scenario": NAME or document}; a sensor or axis of the document may be {"fit": "fit_..."}, a stored fit,
/// or {"table": {"device", "axis", "method", "model", "schedule", "hysteresis_deg_s", "step_deg_s"}}, the models of a
/// device's parameter table by |rate| (core/analysis/table_schedule.hpp); what they hold is written into the request
/// when it is queued. `parameters`: {"runs", "seed", "relative_precision"}, all optional.
#include "schema/json/outage_evaluation.hpp"

#include "core/analysis/table_schedule.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/imu_model.hpp"
#include "schema/json/outage_scenario.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/stored_sensor.hpp"
#include "server/jobs/stored_table.hpp"

namespace driftlab::server {
namespace {

/// Puts the processes of a stored fit in the place of its id.
Status resolve_fit(Json& node, const std::string& pointer, JobContext& context, Faults& faults) {
  auto fit = context.store.fit(node["fit"].get<std::string>());
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
Status resolve_table(Json& node, const std::string& pointer, JobContext& context, Faults& faults) {
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
  auto table = stored_table(context.store, wanted);
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

/// Puts what is stored in the place of its names, so that the request says all by itself.
Status resolve_stored(Json& node, const std::string& pointer, JobContext& context, StoredSensors& sensors,
                      Faults& faults, int depth = 0) {
  if (!node.is_structured() || depth > kMaxJsonDepth) {
    return {};
  }
  if (node.is_object() && node.contains("simulation_model")) {
    return resolve_simulation_model(node, pointer, context.store, sensors, faults);
  }
  if (node.is_object() && node.contains("fit") && node["fit"].is_string()) {
    return resolve_fit(node, pointer, context, faults);
  }
  if (node.is_object() && node.contains("table") && node["table"].is_object()) {
    return resolve_table(node, pointer, context, faults);
  }
  for (const auto& [name, child] : node.items()) {  // of an array the names are the indices
    std::string where = pointer;
    where.append("/").append(name);
    if (auto status = resolve_stored(child, where, context, sensors, faults, depth + 1); !status) {
      return status;
    }
  }
  return {};
}

/// Known biases of the truth's models as deterministic errors of the truth. A truth that is no object is left as it is,
/// for the reader of scenarios to refuse.
void add_biases(Json& scenario, const StoredSensors& sensors, const std::string& pointer, Faults& faults) {
  if (!scenario.is_object() || !scenario.contains("truth") || !scenario["truth"].is_object()) {
    return;
  }
  for (const auto& [errors, bias] : sensors.truth_bias.items()) {
    Json& own = scenario["truth"][errors];
    if (!own.is_null() && (!own.is_object() || own.contains("bias"))) {
      std::string where = pointer;
      where.append("/truth/").append(errors).append("/bias");
      faults.add(std::move(where), ErrorCode::InvalidArgument, "The simulation model has a bias of its own.");
      continue;
    }
    own["bias"] = bias;
  }
}

class OutageEvaluationKind final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "outage_evaluation"; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    ObjectReader reader(inputs, "/inputs", faults);
    const Json* const scenario = reader.member("scenario");
    reader.reject_unknown();
    const OutageOptions options = outage_options_from_json(parameters, "/parameters", faults);
    Json resolved;
    StoredSensors sensors;
    if (scenario == nullptr) {
      faults.add("/inputs/scenario", ErrorCode::InvalidArgument, "Name a scenario or give its document.");
    } else {
      resolved = *scenario;
      if (auto status = resolve_stored(resolved, "/inputs/scenario", context, sensors, faults); !status) {
        return fail(status.error());
      }
      add_biases(resolved, sensors, "/inputs/scenario", faults);
    }
    if (faults.none()) {
      (void)scenario_or_name(resolved, "/inputs/scenario", faults);
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    Json complete{{"scenario", std::move(resolved)}};
    if (!sensors.left_out.empty()) {
      complete["left_out"] = std::move(sensors.left_out);
    }
    return Json{{"kind", name()},
                {"inputs", std::move(complete)},
                {"parameters", to_json(options)},
                {"algorithm_version", kOutageAlgorithmVersion}};
  }

  /// The motion of the drive, which all runs share; the runs themselves take their errors sample by sample.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& /*context*/) const override {
    constexpr double kBytesPerSample = 160.0;
    Faults faults;
    const OutageScenario scenario = scenario_or_name(request["inputs"]["scenario"], "/inputs/scenario", faults);
    JobCost cost;
    cost.memory_bytes += static_cast<std::int64_t>(kBytesPerSample * scenario.drive.duration_s * scenario.imu_rate_hz);
    return cost;
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& /*context*/,
                                       const RunControl& control) const override {
    Faults faults;
    const OutageScenario scenario = scenario_or_name(request["inputs"]["scenario"], "/inputs/scenario", faults);
    const OutageOptions options = outage_options_from_json(request["parameters"], "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    auto report = report_outages(scenario, options, control);
    if (!report) {
      return fail(report.error());
    }
    JobResults results;
    Json document = to_json(*report);
    if (const Json& inputs = request["inputs"]; inputs.contains("left_out")) {
      document["left_out"] = inputs["left_out"];
    }
    results.document_json = to_text(document);
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_outage_evaluation_kind() { return std::make_unique<OutageEvaluationKind>(); }

}  // namespace driftlab::server
