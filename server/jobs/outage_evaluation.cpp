/// The job kind `outage_evaluation`: filters compared through simulated GNSS outages
/// (core/navigate/outage_evaluation.hpp).
///
/// `inputs`: {"scenario": NAME or document}; a sensor or axis of the document may be {"fit": "fit_..."}, a stored fit,
/// or {"table": {"device", "axis", "method", "model", "schedule", "hysteresis_deg_s", "step_deg_s"}}, the models of a
/// device's parameter table by |rate| (core/analysis/table_schedule.hpp); what they hold is written into the request
/// when it is queued. `parameters`: {"runs", "seed", "relative_precision"}, all optional.
#include "schema/json/outage_evaluation.hpp"

#include "schema/json/outage_scenario.hpp"
#include "server/jobs/job_parts.hpp"
#include "server/jobs/stored_models.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

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

class OutageEvaluationKind final : public DividedKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "outage_evaluation"; }
  [[nodiscard]] int version() const override { return kOutageAlgorithmVersion; }

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
      if (auto status = resolve_stored(resolved, "/inputs/scenario", context.store, sensors, faults); !status) {
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
    return Json{{"kind", name()}, {"inputs", std::move(complete)}, {"parameters", to_json(options)}};
  }

  /// The motion of the drive, which all runs share; the runs themselves take their errors sample by sample.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& /*context*/) const override {
    constexpr double kBytesPerSample = 160.0;
    constexpr double kEpochsPerSecond = 1e6;  // of one filter (tests/bench/navigate.md)
    constexpr int kFewestRuns = 20;           // of an evaluation that ends once it knows enough
    Faults faults;
    const OutageScenario scenario = scenario_or_name(request["inputs"]["scenario"], "/inputs/scenario", faults);
    const OutageOptions options = outage_options_from_json(request["parameters"], "/parameters", faults);
    const double epochs = scenario.drive.duration_s * scenario.imu_rate_hz;
    const int runs = options.relative_precision > 0.0 ? std::min(options.runs, kFewestRuns) : options.runs;
    JobCost cost;
    cost.memory_bytes += static_cast<std::int64_t>(kBytesPerSample * epochs);
    cost.shared_seconds = epochs * runs * static_cast<double>(scenario.filters.size()) / kEpochsPerSecond;
    return cost;
  }

  [[nodiscard]] Result<JobResults> run_in_parts(const Json& request, JobContext& /*context*/, const RunControl& control,
                                                JobParts& parts) const override {
    Faults faults;
    const OutageScenario scenario = scenario_or_name(request["inputs"]["scenario"], "/inputs/scenario", faults);
    const OutageOptions options = outage_options_from_json(request["parameters"], "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    control.report("trajectory", 0.0);
    auto batches = OutageBatches::make(scenario, options, control.stop);
    if (!batches) {
      return fail(batches.error());
    }
    const auto compute = [&](std::size_t number, const RunControl& part) { return batches->run(number, part); };
    const auto take = [&](OutageBatch batch) { return batches->add(std::move(batch)); };
    if (auto shared = share_values<OutageBatch>(parts, batches->count(), compute, take, control); !shared) {
      return fail(shared.error());
    }
    const OutageReport report = report_of(scenario, batches->evaluate());
    JobResults results;
    Json document = to_json(report);
    if (const Json& inputs = request["inputs"]; inputs.contains("left_out")) {
      document["left_out"] = inputs["left_out"];
    }
    results.document_json = to_text(document);
    results.verdicts.push_back(
        {.level = std::string(driftlab::name_of(report.summary.level)), .verdict = report.summary.sentence});
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_outage_evaluation_kind() { return std::make_unique<OutageEvaluationKind>(); }

}  // namespace driftlab::server
