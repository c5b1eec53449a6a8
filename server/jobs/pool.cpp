/// The job kind `pool`: the latest results of one sensor axis in, their joint fits out
/// (core/campaign/pooled_sensor.hpp).
///
/// Nobody has to ask for it: the store queues one in the transaction that changes the latest results of an axis, and
/// cancels the one it replaces (server/store/pool_job.hpp). `inputs`: {"device", "sensor", "axis"} as a parameter table
/// names them; the job is that of the results which are the latest at this moment. Whoever reads a pooling that failed
/// asks for it again so. The result is computed from the members alone, in an order that is theirs: whatever ended
/// first, and on however many workers, the same results give the same document.
#include "core/signal/quantity.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "server/jobs/axis_sources.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/kept_table.hpp"
#include "server/store/pool_job.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

std::vector<std::string> members_of(const AxisResults& axis) {
  std::vector<std::string> members;
  for (const ChannelResult& result : axis.latest) {
    members.push_back(result.id);
  }
  std::sort(members.begin(), members.end());
  return members;
}

/// The axis that `inputs` name, in the words of a table. Errors: those of the store.
Result<SensorAxis> read_axis(const Json& inputs, Store& store, Faults& faults) {
  SensorAxis wanted;
  ObjectReader reader(inputs, "/inputs", faults);
  const std::string device = reader.required_text("device");
  const std::string sensor = reader.text("sensor").value_or("gyroscope");
  wanted.axis = reader.required_text("axis");
  reader.reject_unknown();
  if (const auto quantity = quantity_of_sensor(sensor)) {
    wanted.quantity = driftlab::name_of(*quantity);
    if (!is_axis_of(wanted.axis, *quantity)) {
      faults.add("/inputs/axis", ErrorCode::InvalidArgument, "The axis must be x, y or z, not '" + wanted.axis + "'.");
    }
  } else {
    faults.add("/inputs/sensor", quantity.error());
  }
  auto row = store.device(device);
  if (row) {
    wanted.device_id = row->id;
  } else if (row.error().code == ErrorCode::NotFound) {
    faults.add("/inputs/device", row.error());
  } else {
    return fail(row.error());
  }
  return wanted;
}

class Pool final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return kPoolKind; }
  [[nodiscard]] int version() const override { return kPoolVersion; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    auto axis = read_axis(inputs, context.store, faults);
    if (!axis) {
      return fail(axis.error());
    }
    ObjectReader(parameters, "/parameters", faults).reject_unknown();
    if (!faults.none()) {
      return fail(faults.error());
    }
    auto results = context.store.axis_results(*axis);
    if (!results) {
      return fail(results.error());
    }
    if (results->latest.size() < 2) {
      faults.add("/inputs/axis", ErrorCode::NotFound, "The axis has fewer than two results; there is nothing to pool.");
      return fail(faults.error());
    }
    return parse_json(pool_job(*axis, members_of(*results)).request_json);
  }

  /// Measured (tests/RELIABILITY.md): what the results of each member hold, and the joint fits over all of them.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& /*context*/) const override {
    constexpr std::int64_t kBytesPerMember = std::int64_t{1} << 19;
    constexpr double kSecondsPerMember = 0.02;
    const auto members = static_cast<std::int64_t>(request["inputs"]["members"].size());
    return {JobCost{}.memory_bytes + kBytesPerMember * members, kSecondsPerMember * static_cast<double>(members)};
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const override {
    const Json& inputs = request["inputs"];
    const SensorAxis axis{inputs["device"].get<std::string>(), inputs["quantity"].get<std::string>(),
                          inputs["axis"].get<std::string>()};
    auto latest = context.store.axis_results(axis);
    if (!latest) {
      return fail(latest.error());
    }
    if (Json(members_of(*latest)) != inputs["members"]) {
      return fail(ErrorCode::Cancelled, "The axis has newer results, which another job pools.");
    }
    auto sources = sources_of(*latest);
    if (!sources) {
      return fail(sources.error());
    }
    const auto pooled = pool_sensor(*sources, {}, control);
    if (!pooled) {
      return fail(pooled.error());
    }
    Json document = to_json(*pooled);
    document["device"] = axis.device_id;
    JobResults results;
    results.document_json = to_text(document);
    results.pooled = true;
    // As whoever reads it gets it.
    const auto read = parse_json(results.document_json).and_then(pooled_sensor_from_json);
    if (auto table = read ? keep_table(context.store, axis, std::move(*sources), *read) : std::nullopt) {
      results.artefacts.push_back(std::move(*table));
    }
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_pool_kind() { return std::make_unique<Pool>(); }

}  // namespace driftlab::server
