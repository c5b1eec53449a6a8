/// The job kind `toy`: recordings in, the mean of each of their channels out. `inputs`: {"recordings": ["rec_..."]}.
#include "core/analysis/toy.hpp"

#include "schema/json/toy.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/stored_recordings.hpp"

namespace driftlab::server {
namespace {

class Toy final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return "toy"; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    ObjectReader reader(inputs, "/inputs", faults);
    const Json* const list = reader.member("recordings");
    reader.reject_unknown();
    ObjectReader(parameters, "/parameters", faults).reject_unknown();
    Json pinned = Json::array();
    for (const Json& id : list != nullptr && list->is_array() ? *list : Json::array()) {
      auto recording = id.is_string() ? context.store.recording(id.get<std::string>())
                                      : Result<Recording>(fail(ErrorCode::NotFound, "There is no such recording."));
      if (!recording) {
        faults.add("/inputs/recordings", recording.error());
        continue;
      }
      pinned.push_back(Json{{"id", recording->id}, {"revision", recording->revision}});
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    return Json{{"kind", name()},
                {"inputs", {{"recordings", std::move(pinned)}}},
                {"parameters", Json::object()},
                {"algorithm_version", 1}};
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& control) const override {
    StoredRecordings recordings(context.store, context.blobs, recordings_from_request(request["inputs"]["recordings"]));
    const auto report = toy(recordings, control);
    if (!report) {
      return fail(report.error());
    }
    JobResults results;
    results.document_json = to_text(to_json(*report));
    return results;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_toy_kind() { return std::make_unique<Toy>(); }

}  // namespace driftlab::server
