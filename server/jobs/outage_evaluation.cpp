#include "server/jobs/outage_evaluation.hpp"

#include "schema/json/outage_evaluation.hpp"
#include "schema/json/outage_scenario.hpp"

#include <algorithm>
#include <thread>

namespace driftlab::server {
namespace {

/// Puts the processes of stored fits in the place of their ids.
Status resolve_fits(Json& node, const std::string& pointer, JobContext& context, Faults& faults, int depth = 0) {
  if (!node.is_structured() || depth > kMaxJsonDepth) {
    return {};
  }
  if (node.is_object() && node.contains("fit") && node["fit"].is_string()) {
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
  for (const auto& [name, child] : node.items()) {  // of an array the names are the indices
    std::string where = pointer;
    where.append("/").append(name);
    if (auto status = resolve_fits(child, where, context, faults, depth + 1); !status) {
      return status;
    }
  }
  return {};
}

/// Half of the processors: an evaluation is one job among others, and its result does not depend on this.
int threads_for_a_job() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency() / 2)); }

class OutageEvaluationKind final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return kOutageEvaluationKind; }

  [[nodiscard]] Result<std::string> canonical_request(std::string_view inputs_json, std::string_view parameters_json,
                                                      JobContext& context) const override {
    auto inputs = parse_json(inputs_json);
    auto parameters = parse_json(parameters_json);
    if (!inputs || !parameters) {
      return fail(inputs ? parameters.error() : inputs.error());
    }
    Faults faults;
    ObjectReader reader(*inputs, "/inputs", faults);
    const Json* const scenario = reader.member("scenario");
    reader.reject_unknown();
    const OutageOptions options = outage_options_from_json(*parameters, "/parameters", faults);
    Json resolved;
    if (scenario == nullptr) {
      faults.add("/inputs/scenario", ErrorCode::InvalidArgument, "Name a scenario or give its document.");
    } else {
      resolved = *scenario;
      if (auto status = resolve_fits(resolved, "/inputs/scenario", context, faults); !status) {
        return fail(status.error());
      }
    }
    if (faults.none()) {
      (void)scenario_or_name(resolved, "/inputs/scenario", faults);
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    return canonical_text(Json{{"kind", name()},
                               {"inputs", {{"scenario", std::move(resolved)}}},
                               {"parameters", to_json(options)},
                               {"algorithm_version", kOutageAlgorithmVersion}});
  }

  [[nodiscard]] Result<JobResults> run(std::string_view request_json, JobContext& /*context*/,
                                       const RunControl& control) const override {
    auto request = parse_json(request_json);
    if (!request) {
      return fail(request.error());
    }
    Faults faults;
    const OutageScenario scenario = scenario_or_name((*request)["inputs"]["scenario"], "/inputs/scenario", faults);
    OutageOptions options = outage_options_from_json((*request)["parameters"], "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    options.threads = threads_for_a_job();
    auto evaluation = evaluate_outages(scenario, options, control);
    if (!evaluation) {
      return fail(evaluation.error());
    }
    JobResults results;
    results.document_json = to_text(to_json(*evaluation, to_json(scenario)));
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_outage_evaluation_kind() { return std::make_unique<OutageEvaluationKind>(); }

}  // namespace driftlab::server
