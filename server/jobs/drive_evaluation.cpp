/// The job kind `drive_evaluation`: what is asked of a stored drive, answered as `driftlab drive` answers it.
///
/// `inputs`: {"drive": "drv_...", "model": {...}, "outages": {...}}; the last two, optional, take the place of the
/// document's. Whole document, revisions of its recordings and what stored models say are written into the request when
/// it is queued. `parameters`: {"question": run | simulate | explain | compare, ...} (schema/json/drive_request.hpp),
/// optional.
#include "core/analysis/drive_verdict.hpp"
#include "schema/json/drive_document.hpp"
#include "schema/json/drive_request.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/stored_drive.hpp"

namespace driftlab::server {
namespace {

/// The stored document with what the request puts in its place, and where faults of each are to be found.
Result<Json> asked_document(const Json& inputs, JobContext& context, std::string& id, Faults& faults) {
  ObjectReader reader(inputs, "/inputs", faults);
  id = reader.required_text("drive");
  const Json* const model = reader.member("model");
  const Json* const outages = reader.member("outages");
  reader.reject_unknown();
  if (!faults.none()) {
    return Json();
  }
  auto row = context.store.drive(id);
  if (!row) {
    if (row.error().code != ErrorCode::NotFound) {
      return fail(row.error());
    }
    faults.add("/inputs/drive", ErrorCode::NotFound, "There is no drive " + id + ".");
    return Json();
  }
  auto document = parse_json(row->document_json);
  if (!document) {
    return fail(document.error());
  }
  if (model != nullptr) {
    (*document)["model"] = *model;
  }
  if (outages != nullptr) {
    (*document)["outages"] = *outages;
  }
  return document;
}

class DriveEvaluationKind final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "drive_evaluation"; }
  [[nodiscard]] int version() const override { return drive::kDriveAlgorithmVersion; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    std::string id;
    const auto document = asked_document(inputs, context, id, faults);
    if (!document) {
      return fail(document.error());
    }
    const DriveRequest wanted = drive_request_from_json(parameters, "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    auto checked = check_stored_drive(*document, "/inputs", context.store, faults);
    if (!checked) {
      return fail(checked.error());
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    Json complete{
        {"drive", id}, {"document", std::move(checked->document)}, {"recordings", std::move(checked->recordings)}};
    if (!checked->left_out.empty()) {
      complete["left_out"] = std::move(checked->left_out);
    }
    return Json{{"kind", name()}, {"inputs", std::move(complete)}, {"parameters", to_json(wanted)}};
  }

  /// Tables, readings with and without repairs, and a corrected copy in each of the filters that run side by side.
  [[nodiscard]] JobCost cost(const Json& request, JobContext& context) const override {
    constexpr std::int64_t kBytesPerCell = 24;
    constexpr std::int64_t kBytesPerRow = 1500;
    const Json& parameters = request["parameters"];
    const bool explains = parameters.value("question", "") == "explain";
    const double fits = parameters.value("fit_noise", false) ? 3.0 : 1.0;  // a search for two levels takes two more
    const double filters =
        parameters.contains("models") ? fits * static_cast<double>(parameters["models"].size()) : 1.0;
    const double seconds_per_row = explains ? 4e-4 : 1e-5 * filters;
    JobCost cost;
    for (const RecordingSize& size : sizes_of(request["inputs"]["recordings"], context.store)) {
      cost.memory_bytes += size.rows * (kBytesPerCell * size.columns + kBytesPerRow);
      cost.seconds += seconds_per_row * static_cast<double>(size.rows);
    }
    return cost;
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const override {
    const Json& inputs = request["inputs"];
    Faults faults;
    const drive::Document document = drive_from_json(inputs["document"], faults, "recording", "/inputs");
    const DriveRequest wanted = drive_request_from_json(request["parameters"], "/parameters", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    StoredDriveFiles files(context.store, context.blobs, inputs["recordings"], context.verify_columns);
    const auto tables = open_tables(document, files, control);
    if (!tables) {
      return fail(tables.error());
    }
    const auto answer = answer_drive(wanted, document, *tables, control);
    if (!answer) {
      return fail(answer.error());
    }
    Json result = to_json(*answer);
    if (inputs.contains("left_out")) {
      result["left_out"] = inputs["left_out"];
    }
    JobResults results;
    results.document_json = to_text(result);
    const Verdict verdict = verdict_of(*answer);
    results.verdicts.push_back({.level = std::string(driftlab::name_of(verdict.level)), .verdict = verdict.sentence});
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_drive_evaluation_kind() { return std::make_unique<DriveEvaluationKind>(); }

}  // namespace driftlab::server
