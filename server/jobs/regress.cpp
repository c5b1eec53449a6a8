/// The job kind `regress`: stored results of recordings before and after a change in, one verdict out
/// (core/analysis/regress.hpp).
///
/// `inputs`: `device`, `baseline`, `candidate`, `history` and `excluded` of a regression request, whose recordings are
/// those of the server (`{"recording": "rec_..."}`). An arm with labels alone is all recordings of the device that have
/// them; the baseline may be "anchor" or "last_pass"; without a `history` it is the releases of earlier runs.
/// `parameters`: its `settings`. The results are pinned when the job is asked for; recordings without one are refused.
/// Looks are counted over the jobs of this kind that have the same device and candidate label: a run over the same
/// recordings is the same look.
#include "core/analysis/regress.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/regression.hpp"
#include "schema/text/regression.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/regression_arms.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace driftlab::server {
namespace {

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
  // What the request says of session and time is for this run; what it does not say the recording does.
  const auto tags = parse_json(recording->tags_json);
  for (const auto& [name, text] : {std::pair{"session", written.session}, {"recorded_at", written.recorded_at}}) {
    const std::string stored = tags && tags->is_object() ? tags->value(name, "") : "";
    if (!text.empty() || !stored.empty()) {
      pinned[name] = text.empty() ? stored : text;
    }
  }
  if (!written.recorded_at.empty()) {
    if (const auto seconds = seconds_of(written.recorded_at); !seconds) {
      faults.add(written.pointer + "/recorded_at", seconds.error());
    }
  }
  add_stated_facts(written.stated, pinned);
  return pinned;
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
    stated_facts_of(pinned).tell(*compared);
    recordings.recordings.push_back(std::move(*compared));
  }
  return recordings;
}

/// The arms of a request with the recordings that they mean, each with the results that it is compared by.
class PinnedArms {
 public:
  PinnedArms(Store& store, const Device& device, const RegressionMemory& memory, const ResultsByRecording& results,
             const std::vector<regression::Exclusion>& excluded, Faults& faults)
      : store_(store), device_(device), memory_(memory), results_(results), excluded_(excluded), faults_(faults) {}

  /// Finds the recordings of an arm that names none. Errors: those of the store.
  [[nodiscard]] Status complete(WrittenArm& arm, const std::string& pointer) const {
    if (!arm.special.empty()) {
      auto label = arm.special == "anchor" ? memory_.anchor() : memory_.last_pass();
      if (!label) {
        return fail(label.error());
      }
      arm.label = std::move(*label);
      if (arm.label.empty()) {
        faults_.add(pointer, ErrorCode::InvalidArgument,
                    arm.special == "anchor"
                        ? "This device has no anchor yet: name a baseline with labels, which becomes the anchor."
                        : "No run of this device has passed yet: name a baseline.");
        return {};
      }
    }
    if (!arm.recordings.empty()) {
      return {};
    }
    if (arm.label.empty()) {
      faults_.add(pointer, ErrorCode::InvalidArgument, "Name the recordings of this arm, or labels that they have.");
      return {};
    }
    auto found = memory_.recordings(arm.label, pointer);
    if (!found) {
      return fail(found.error());
    }
    arm.recordings = std::move(*found);
    if (arm.recordings.empty()) {
      auto sentence = memory_.unknown_label(arm.label);
      if (!sentence) {
        return fail(sentence.error());
      }
      faults_.add(pointer + "/labels", ErrorCode::NotFound, std::move(*sentence));
    }
    return {};
  }

  [[nodiscard]] Json pinned(const WrittenArm& arm) const {
    Json recordings = Json::array();
    for (const WrittenRecording& recording : arm.recordings) {
      if (!is_excluded(recording.recording)) {
        recordings.push_back(pinned_recording(recording, device_, results_, store_, faults_));
      }
    }
    return Json{{"label", arm.label}, {"recordings", std::move(recordings)}};
  }

  /// The releases of earlier runs, oldest first, as far as their recordings are there, have results and are in neither
  /// arm. Errors: those of the store.
  [[nodiscard]] Result<Json> earlier_releases(const WrittenArm& baseline, const WrittenArm& candidate) const {
    Json releases = Json::array();
    for (const std::string& label : memory_.labels()) {
      auto found = label == baseline.label || label == candidate.label
                       ? Result<std::vector<WrittenRecording>>(std::vector<WrittenRecording>{})
                       : memory_.recordings(label, "/inputs/history");
      if (!found) {
        return fail(found.error());
      }
      WrittenArm release{label, "", {}};
      for (WrittenRecording& recording : *found) {
        const auto same = [&](const WrittenRecording& other) { return other.recording == recording.recording; };
        const bool elsewhere = std::any_of(baseline.recordings.begin(), baseline.recordings.end(), same) ||
                               std::any_of(candidate.recordings.begin(), candidate.recordings.end(), same);
        if (!elsewhere && results_.contains(recording.recording) && !is_excluded(recording.recording)) {
          release.recordings.push_back(std::move(recording));
        }
      }
      if (!release.recordings.empty()) {
        releases.push_back(pinned(release));
      }
    }
    return releases;
  }

 private:
  [[nodiscard]] bool is_excluded(const std::string& id) const {
    return std::any_of(excluded_.begin(), excluded_.end(),
                       [&](const regression::Exclusion& exclusion) { return exclusion.recording == id; });
  }

  Store& store_;
  const Device& device_;
  const RegressionMemory& memory_;
  const ResultsByRecording& results_;
  const std::vector<regression::Exclusion>& excluded_;
  Faults& faults_;
};

/// How many of the releases came before the baseline, in the order in which runs named them.
std::size_t releases_before(const Json& releases, const RegressionMemory& memory, const std::string& baseline) {
  const auto& order = memory.labels();
  const auto place = std::find(order.begin(), order.end(), baseline);
  return static_cast<std::size_t>(std::count_if(releases.begin(), releases.end(), [&](const Json& release) {
    return std::find(order.begin(), place, release["label"].get<std::string>()) != place;
  }));
}

/// The inputs with everything pinned. `history` is that of the request, or what the server remembers.
Result<Json> pinned_inputs(WrittenRegression& written, const Device& device, const RegressionMemory& memory,
                           const ResultsByRecording& results, Store& store, Faults& faults) {
  const PinnedArms arms(store, device, memory, results, written.excluded, faults);
  for (const auto& [arm, pointer] :
       {std::pair{&written.baseline, "/inputs/baseline"}, {&written.candidate, "/inputs/candidate"}}) {
    if (Status found = arms.complete(*arm, pointer); !found) {
      return fail(found.error());
    }
  }
  const std::string& label = written.candidate.label;
  if (!label.empty() && label == written.baseline.label) {
    faults.add("/inputs/candidate", ErrorCode::InvalidArgument,
               "Baseline and candidate have the same label, " + label + ".");
  }
  Json inputs{{"device", device.id},
              {"device_name", device.name},
              {"baseline", arms.pinned(written.baseline)},
              {"candidate", arms.pinned(written.candidate)},
              {"history", Json::array()},
              {"excluded", Json::array()}};
  for (std::size_t i = 0; i < written.history.size(); ++i) {
    if (Status found = arms.complete(written.history[i], "/inputs/history/" + std::to_string(i)); !found) {
      return fail(found.error());
    }
    inputs["history"].push_back(arms.pinned(written.history[i]));
  }
  if (written.history.empty() && !label.empty() && faults.none()) {
    auto releases = arms.earlier_releases(written.baseline, written.candidate);
    if (!releases) {
      return fail(releases.error());
    }
    if (!releases->empty()) {
      inputs["before_baseline"] = releases_before(*releases, memory, written.baseline.label);
      inputs["previous"] = releases->size() - 1;
    }
    inputs["history"] = std::move(*releases);
  }
  for (const regression::Exclusion& exclusion : written.excluded) {
    inputs["excluded"].push_back(Json{{"recording", exclusion.recording}, {"reason", exclusion.reason}});
  }
  return inputs;
}

/// What people and pipelines read beside the document. The page shows the figure at an address that is filled in when
/// the page is asked for.
std::vector<Artefact> artefacts_of(const RegressReport& report) {
  return {{"text", regression_to_text(report)},          {"markdown", regression_to_markdown(report, "FIGURE")},
          {"junit", regression_to_junit(report, false)}, {"junit_open_skipped", regression_to_junit(report, true)},
          {"figure", regression_to_svg(report)},         {"badge", regression_to_badge(report)}};
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
    auto memory = RegressionMemory::of(context.store, *device);
    if (!results || !memory) {
      return fail(!results ? results.error() : memory.error());
    }
    auto canonical = pinned_inputs(written, *device, *memory, *results, context.store, faults);
    if (!canonical) {
      return fail(canonical.error());
    }
    if (!faults.none()) {
      return fail(faults.error());
    }
    const bool counted = !written.candidate.label.empty();
    const std::size_t look =
        counted ? memory->look(written.candidate.label, regressed_ids((*canonical)["candidate"])) : 1;
    if (const auto share = look_share({look, written.looks, counted}); !share) {
      return fail(share.error());
    }
    Json settings = driftlab::to_json(written.settings, written.looks);
    return Json{{"kind", name()},
                {"inputs", std::move(*canonical)},
                {"parameters", std::move(settings)},
                {"look", {{"number", look}, {"counted", counted}}},
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
    if (inputs.contains("previous")) {
      comparison.before_baseline = inputs["before_baseline"].get<std::size_t>();
      wanted.previous = comparison.history[inputs["previous"].get<std::size_t>()];
    }
    const auto report = regress(wanted);
    if (!report) {
      return fail(report.error());
    }
    JobResults made;
    made.document_json = to_text(driftlab::to_json(*report));
    made.artefacts = artefacts_of(*report);
    return made;
  }
};

}  // namespace

std::unique_ptr<JobKind> make_regress_kind() { return std::make_unique<Regress>(); }

}  // namespace driftlab::server
