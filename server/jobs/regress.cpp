/// The job kind `regress`: stored results of recordings before and after a change in, one verdict out
/// (core/analysis/regress.hpp).
///
/// `inputs`: `device`, `baseline`, `candidate`, `history` and `excluded` of a regression request, whose recordings are
/// those of the server (`{"recording": "rec_..."}`). `parameters`: its `settings`. The results are pinned when the job
/// is asked for; recordings without one are refused. Looks are counted over the jobs of this kind that have the same
/// device and candidate label: a run over the same recordings is the same look.
#include "core/analysis/regress.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/regression.hpp"
#include "server/jobs/job_kind.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::string_view kRegressKind = "regress";
constexpr int kPage = 500;

/// The latest results of all sensor axes of a device, by recording.
using ResultsByRecording = std::map<std::string, std::vector<ChannelResult>>;

Result<ResultsByRecording> results_of(Store& store, const std::string& device_id) {
  ResultsByRecording results;
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      auto latest = store.latest_channel_results(device_id, driftlab::name_of(quantity), axis);
      if (!latest) {
        return fail(latest.error());
      }
      for (ChannelResult& result : *latest) {
        results[result.recording_id].push_back(std::move(result));
      }
    }
  }
  return results;
}

/// One recording of an arm with the results that it is compared by.
Json pinned_recording(const WrittenRecording& written, const Device& device, const ResultsByRecording& results,
                      Store& store, Faults& faults) {
  if (written.recording.empty()) {
    faults.add(written.pointer, ErrorCode::InvalidArgument,
               "Here a recording is one of the server: {\"recording\": id}.");
    return {};
  }
  auto recording = store.recording(written.recording);
  if (!recording || recording->device_id != device.id) {
    faults.add(
        written.pointer + "/recording", ErrorCode::NotFound,
        recording ? "The recording " + written.recording + " is one of another device." : recording.error().message);
    return {};
  }
  const auto found = results.find(written.recording);
  if (found == results.end()) {
    faults.add(written.pointer + "/recording", ErrorCode::NotFound,
               "The recording " + written.recording + " has no results yet: queue a characterise job first.");
    return {};
  }
  Json ids = Json::array();
  for (const ChannelResult& result : found->second) {
    ids.push_back(result.id);
  }
  Json pinned{{"recording", written.recording}, {"revision", recording->revision}, {"results", std::move(ids)}};
  for (const auto& [name, text] : {std::pair{"session", written.session}, {"recorded_at", written.recorded_at}}) {
    if (!text.empty()) {
      pinned[name] = text;
    }
  }
  if (!written.recorded_at.empty()) {
    if (const auto seconds = seconds_of(written.recorded_at); !seconds) {
      faults.add(written.pointer + "/recorded_at", seconds.error());
    }
  }
  if (written.temperature_degc) {
    pinned["temperature_degc"] = *written.temperature_degc;
  }
  if (!written.causes.empty()) {
    pinned["causes"] = written.causes;
  }
  return pinned;
}

std::vector<std::string> ids_of(const Json& arm) {
  std::vector<std::string> ids;
  for (const Json& recording : arm["recordings"]) {
    ids.push_back(recording["recording"].get<std::string>());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// The number of the look that a run over the candidate is, among those asked for before.
Result<std::size_t> count_look(Store& store, const std::string& device_id, const Json& candidate) {
  std::set<std::vector<std::string>> before;
  const std::vector<std::string> own = ids_of(candidate);
  std::vector<std::vector<std::string>> order;
  Page page{.after = "", .limit = kPage};
  for (bool more = true; more;) {
    auto jobs = store.jobs({std::string(kRegressKind), std::nullopt}, page);
    if (!jobs) {
      return fail(jobs.error());
    }
    for (const Job& job : *jobs) {
      const bool stands =
          job.state == JobState::Queued || job.state == JobState::Running || job.state == JobState::Succeeded;
      const auto request = parse_json(job.request_json);
      if (!stands || !request || (*request)["inputs"]["device"] != device_id ||
          (*request)["inputs"]["candidate"]["label"] != candidate["label"]) {
        continue;
      }
      if (const auto ids = ids_of((*request)["inputs"]["candidate"]); before.insert(ids).second) {
        order.push_back(ids);
      }
    }
    more = static_cast<int>(jobs->size()) == kPage;
    page.after = jobs->empty() ? "" : jobs->back().id;
  }
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), own) - order.begin()) + 1;
}

/// A stored recording as a member of a characterisation (core/campaign/regression/recordings.hpp reads no more).
Result<Json> characterisation_of(Store& store, const std::string& id, const std::vector<ChannelResult>& results) {
  auto recording = store.recording(id);
  if (!recording) {
    return fail(recording.error());
  }
  auto quality = parse_json(recording->quality_json);
  auto condition = parse_condition(recording->condition);
  if (!quality || !condition) {
    return fail(ErrorCode::Internal, "The stored recording " + id + " cannot be read.");
  }
  Json channels = Json::array();
  for (const ChannelResult& result : results) {
    auto channel = parse_json(result.document_json);
    if (!channel) {
      return fail(channel.error());
    }
    channels.push_back(std::move(*channel));
  }
  const double dt_s = channels.front()["dt_s"].get<double>();
  const double samples = channels.front()["samples"].get<double>() + channels.front().value("missing", 0.0);
  return Json{{"id", id},
              {"condition", driftlab::to_json(*condition)},
              {"duration_s", samples * dt_s},
              {"rate_hz", 1.0 / dt_s},
              {"quality", std::move(*quality)},
              {"channels", std::move(channels)}};
}

/// The recordings of a pinned arm. Error: Cancelled, where a recording has newer results than the pinned ones.
Result<regression::Recordings> recordings_of(Store& store, const Json& arm, const ResultsByRecording& results) {
  regression::Recordings recordings{arm["label"].get<std::string>(), {}};
  for (const Json& pinned : arm["recordings"]) {
    const std::string id = pinned["recording"].get<std::string>();
    const auto found = results.find(id);
    Json ids = Json::array();
    for (const ChannelResult& result : found == results.end() ? std::vector<ChannelResult>{} : found->second) {
      ids.push_back(result.id);
    }
    if (ids != pinned["results"]) {
      return fail(ErrorCode::Cancelled, "The recording " + id + " has newer results; ask for the run again.");
    }
    auto document = characterisation_of(store, id, found->second);
    auto compared = document ? compared_recording_from_json(*document)
                             : Result<regression::ComparedRecording>(fail(document.error()));
    if (!compared) {
      return fail(compared.error());
    }
    compared->session = pinned.value("session", "");
    if (const std::string time = pinned.value("recorded_at", ""); !time.empty()) {
      if (const auto seconds = seconds_of(time)) {
        compared->began_s = *seconds;
      }
    }
    if (pinned.contains("temperature_degc")) {
      compared->temperature_degc = pinned["temperature_degc"].get<double>();
    }
    compared->causes = pinned.value("causes", std::vector<std::string>{});
    recordings.recordings.push_back(std::move(*compared));
  }
  return recordings;
}

class Regress final : public JobKind {
 public:
  [[nodiscard]] std::string_view name() const override { return kRegressKind; }

  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                               JobContext& context) const override {
    Faults faults;
    WrittenRegression written = regression_from_json(inputs, faults);
    regression_settings_from_json(parameters, "/parameters", written, faults);
    auto device = context.store.device(written.device);
    if (!device) {
      if (device.error().code != ErrorCode::NotFound) {
        return fail(device.error());
      }
      faults.add("/inputs/device", device.error());
      return fail(faults.error());
    }
    auto results = results_of(context.store, device->id);
    if (!results) {
      return fail(results.error());
    }
    const auto pinned_arm = [&](const WrittenArm& arm, const std::string& pointer) {
      Json recordings = Json::array();
      if (!arm.special.empty() || arm.recordings.empty()) {
        faults.add(pointer, ErrorCode::InvalidArgument, "Name the recordings of this arm.");
      }
      for (const WrittenRecording& recording : arm.recordings) {
        const bool left_out = std::any_of(
            written.excluded.begin(), written.excluded.end(),
            [&](const regression::Exclusion& exclusion) { return exclusion.recording == recording.recording; });
        if (!left_out) {
          recordings.push_back(pinned_recording(recording, *device, *results, context.store, faults));
        }
      }
      return Json{{"label", arm.label}, {"recordings", std::move(recordings)}};
    };
    Json canonical{{"device", device->id},
                   {"device_name", device->name},
                   {"baseline", pinned_arm(written.baseline, "/inputs/baseline")},
                   {"candidate", pinned_arm(written.candidate, "/inputs/candidate")},
                   {"history", Json::array()},
                   {"excluded", Json::array()}};
    for (const WrittenArm& release : written.history) {
      canonical["history"].push_back(
          pinned_arm(release, "/inputs/history/" + std::to_string(canonical["history"].size())));
    }
    for (const regression::Exclusion& exclusion : written.excluded) {
      canonical["excluded"].push_back(Json{{"recording", exclusion.recording}, {"reason", exclusion.reason}});
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    const bool counted = !written.candidate.label.empty();
    auto look = counted ? count_look(context.store, device->id, canonical["candidate"]) : Result<std::size_t>(1);
    if (!look) {
      return fail(look.error());
    }
    if (const auto share = look_share({*look, written.looks, counted}); !share) {
      return fail(share.error());
    }
    Json settings = driftlab::to_json(written.settings, written.looks);
    return Json{{"kind", name()},
                {"inputs", std::move(canonical)},
                {"parameters", std::move(settings)},
                {"look", {{"number", *look}, {"counted", counted}}},
                {"algorithm_version", kRegressionVersion}};
  }

  [[nodiscard]] Result<JobResults> run(const Json& request, JobContext& context,
                                       const RunControl& /*control*/) const override {
    const Json& inputs = request["inputs"];
    auto results = results_of(context.store, inputs["device"].get<std::string>());
    if (!results) {
      return fail(results.error());
    }
    Faults faults;
    WrittenRegression written;
    regression_settings_from_json(request["parameters"], "/parameters", written, faults);
    if (!faults.none()) {
      return fail(faults.error());
    }
    RegressRequest wanted;
    wanted.look = {request["look"]["number"].get<std::size_t>(), written.looks, request["look"]["counted"].get<bool>()};
    regression::Request& comparison = wanted.comparison;
    comparison.device = inputs["device_name"].get<std::string>();
    comparison.settings = written.settings;
    for (const Json& exclusion : inputs["excluded"]) {
      comparison.excluded.push_back(
          {exclusion["recording"].get<std::string>(), exclusion["reason"].get<std::string>()});
    }
    for (const auto& [name, arm] :
         {std::pair{"baseline", &comparison.baseline}, std::pair{"candidate", &comparison.candidate}}) {
      auto recordings = recordings_of(context.store, inputs[name], *results);
      if (!recordings) {
        return fail(recordings.error());
      }
      *arm = std::move(*recordings);
    }
    for (const Json& release : inputs["history"]) {
      auto recordings = recordings_of(context.store, release, *results);
      if (!recordings) {
        return fail(recordings.error());
      }
      comparison.history.push_back(std::move(*recordings));
    }
    const auto report = regress(wanted);
    if (!report) {
      return fail(report.error());
    }
    JobResults made;
    made.document_json = to_text(driftlab::to_json(*report));
    return made;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_regress_kind() { return std::make_unique<Regress>(); }

}  // namespace driftlab::server
