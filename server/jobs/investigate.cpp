/// The job kind `investigate`: a study in, what its baseline simulation gets wrong out, and the extended model as a
/// stored revision.
///
/// `inputs`: {"study": "stu_..."}. `parameters`: {"baseline": {...}} in place of the study's own, optional. A baseline
/// that names a stored model (`{"kind": "model", "id": "mod_..."}`) makes that the parent of the revision; any other is
/// stored as a model first.
#include "core/analysis/investigate.hpp"

#include "schema/json/investigation.hpp"
#include "schema/json/simulation_model.hpp"
#include "schema/json/unnamed_effect.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/stored_baseline.hpp"
#include "server/jobs/stored_recordings.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// {"id", "revision", "name"} of every recording of a stored study.
Result<Json> pinned_recordings(const Json& study, JobContext& context, Faults& faults) {
  Json pinned = Json::array();
  for (const Json& entry : study["recordings"]) {
    const std::string id = entry["recording"].get<std::string>();
    auto recording = context.store.recording(id);
    if (!recording) {
      if (recording.error().code != ErrorCode::NotFound) {
        return fail(recording.error());
      }
      faults.add("/inputs/study", ErrorCode::NotFound, "The study's recording " + id + " has been removed.");
      continue;
    }
    pinned.push_back(Json{{"id", id}, {"revision", recording->revision}, {"name", entry.value("id", id)}});
  }
  return pinned;
}

/// The rows that a finished investigation leaves behind.
class Rows {
 public:
  Rows(const Json& request, const Study& study, UtcMicros now)
      : request_(request), study_(study), now_(now), id_(make_id("inv", now)) {}

  [[nodiscard]] JobResults of(const investigate::Report& report) {
    JobResults results;
    Investigation row;
    row.id = id_;
    row.device_id = study_.device_id;
    row.study_id = study_.id;
    row.baseline_id = baseline_model(report, results);
    const bool extended = !report.findings.empty() || !report.unnamed.empty();
    row.model_id = extended ? extended_model(report, row.baseline_id, results) : row.baseline_id;
    row.summary_json = to_text(findings_summary(report));
    row.page = investigation_page(report);
    Json document = to_json(report);
    document["id"] = row.id;
    document["device"] = row.device_id;
    document["baseline_model"] = row.baseline_id;
    document["model"] = row.model_id;
    results.document_json = to_text(document);
    results.verdicts.push_back({.device_id = row.device_id,
                                .level = std::string(driftlab::name_of(report.summary.level)),
                                .verdict = report.summary.sentence});
    results.investigations.push_back(std::move(row));
    return results;
  }

 private:
  [[nodiscard]] Json provenance(const std::string& what) const {
    return Json{{"made_by", what},
                {"investigation", id_},
                {"study", study_.id},
                {"recordings", request_["inputs"]["recordings"]},
                {"algorithm_version", kInvestigationVersion},
                {"driftlab_version", DRIFTLAB_VERSION}};
  }

  /// The stored model that was named, or a first model made of what was given or fitted.
  [[nodiscard]] std::string baseline_model(const investigate::Report& report, JobResults& results) const {
    const Json& baseline = request_["parameters"]["baseline"];
    if (baseline.value("kind", "") == "model" && baseline.contains("id")) {
      return baseline["id"].get<std::string>();
    }
    Model model;
    model.id = make_id("mod", now_);
    model.device_id = study_.device_id;
    model.unique_key = model.id;
    model.name = "baseline of " + study_.id;
    model.document_json = to_text(baseline_json(report));
    Json from = provenance("investigation");
    from["baseline"] = baseline;
    model.provenance_json = to_text(from);
    results.models.push_back(std::move(model));
    return results.models.back().id;
  }

  [[nodiscard]] std::string extended_model(const investigate::Report& report, const std::string& parent,
                                           JobResults& results) const {
    Model model;
    model.id = make_id("mod", now_);
    model.parent_id = parent;
    model.device_id = study_.device_id;
    model.unique_key = model.id;
    model.name = "extended model of " + study_.id;
    model.document_json = to_text(extended_json(report));
    Json from = provenance("investigation");
    Json changes = Json::array();
    for (const auto& finding : report.findings) {
      changes.push_back(change_json(finding));
    }
    for (const auto& found : report.unnamed) {
      changes.push_back(change_json(found));
    }
    from["changes"] = std::move(changes);
    model.provenance_json = to_text(from);
    results.models.push_back(std::move(model));
    return results.models.back().id;
  }

  const Json& request_;
  const Study& study_;
  UtcMicros now_;
  std::string id_;
};

class Investigate final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "investigate"; }
  [[nodiscard]] int version() const override { return kInvestigationVersion; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    ObjectReader input_reader(inputs, "/inputs", faults);
    const std::string study_id = input_reader.required_text("study");
    input_reader.reject_unknown();
    ObjectReader parameter_reader(parameters, "/parameters", faults);
    const Json* const asked = parameter_reader.member("baseline");
    parameter_reader.reject_unknown();
    if (!faults.none()) {
      return fail(faults.error());
    }
    auto study = context.store.study(study_id);
    if (!study) {
      if (study.error().code != ErrorCode::NotFound) {
        return fail(study.error());
      }
      faults.add("/inputs/study", ErrorCode::NotFound, "There is no study " + study_id + ".");
      return fail(faults.error());
    }
    auto document = parse_json(study->document_json);
    if (!document) {
      return fail(document.error());
    }
    auto pinned = pinned_recordings(*document, context, faults);
    if (!pinned) {
      return fail(pinned.error());
    }
    const Json baseline = asked != nullptr ? *asked : document->value("baseline", Json{{"kind", "auto"}});
    const std::string pointer = asked != nullptr ? "/parameters/baseline" : "/inputs/study";
    auto whole = stored_baseline(baseline, context.store, pointer, faults);
    if (!whole) {
      return fail(whole.error());
    }
    (void)baseline_from_json(*whole, pointer, faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    return Json{{"kind", name()},
                {"inputs", {{"study", study_id}, {"recordings", std::move(*pinned)}}},
                {"parameters", {{"baseline", baseline}}}};
  }

  /// The innovations of every channel, and beside them one channel at a time, in small studies three. Where a gyroscope
  /// may see vibration, up to a million samples of it are looked at one by one
  /// (core/investigate/search/slow_search.cpp).
  [[nodiscard]] JobCost cost(const Json& request, JobContext& context) const override {
    constexpr std::int64_t kBytesKept = 9;
    constexpr std::int64_t kBytesSearched = 80;
    constexpr std::int64_t kBytesVibrating = 480;
    constexpr std::int64_t kMostVibrating = std::int64_t{1} << 20;
    constexpr double kSecondsPerSample = 1e-5;
    JobCost cost;
    std::int64_t rows = 0;
    std::int64_t beside_others = 0;  // rows in which a gyroscope may stand beside an accelerometer
    for (const RecordingSize& size : sizes_of(request["inputs"]["recordings"], context.store)) {
      cost.memory_bytes += (kBytesKept * size.columns + kBytesSearched) * size.rows;
      rows += size.rows;
      beside_others += size.columns > 1 ? size.rows : 0;
      cost.seconds += kSecondsPerSample * static_cast<double>(size.rows * size.columns);
    }
    cost.memory_bytes += kBytesVibrating * std::min(beside_others, kMostVibrating);
    if (rows <= std::int64_t{investigate::kMostRowsSideBySide}) {
      constexpr std::int64_t kOthers = investigate::kSideBySide - 1;
      cost.memory_bytes += kOthers * (kBytesSearched + kBytesVibrating) * beside_others;
    }
    return cost;
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const override {
    auto row = context.store.study(request["inputs"]["study"].get<std::string>());
    if (!row) {
      return fail(row.error());
    }
    Faults faults;
    auto baseline = stored_baseline(request["parameters"]["baseline"], context.store, "/parameters/baseline", faults);
    if (!baseline) {
      return fail(baseline.error());
    }
    InvestigationRequest wanted;
    wanted.study = row->id;
    wanted.device = row->device_id;
    wanted.baseline = baseline_from_json(*baseline, "/parameters/baseline", faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    StoredRecordings recordings(context.store, context.blobs, recordings_from_request(request["inputs"]["recordings"]),
                                context.verify_columns);
    auto report = investigate_study(wanted, recordings, control);
    if (!report) {
      return fail(report.error());
    }
    return Rows(request, *row, context.clock.now()).of(*report);
  }
};

}  // namespace

std::unique_ptr<JobKind> make_investigate_kind() { return std::make_unique<Investigate>(); }

}  // namespace driftlab::server
