#include "server/jobs/pinned_arms.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace driftlab::server {
namespace {

/// One recording of an arm with the results that it is compared by.
Json pinned_recording(const WrittenRecording& written, const Device& device, const DeviceResults& known, Store& store,
                      Faults& faults) {
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
  const auto found = known.results.find(written.recording);
  if (found == known.results.end()) {
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
  StatedFacts facts = written.stated;
  if (const auto of = known.causes.find(written.recording);
      of != known.causes.end() && of->second.revision == recording->revision) {
    facts.add_causes(of->second.identified);
  }
  add_stated_facts(facts, pinned);
  return pinned;
}

/// The arms of a request with the recordings that they mean, each with the results that it is compared by.
class PinnedArms {
 public:
  PinnedArms(Store& store, const Device& device, const RegressionMemory& memory, const DeviceResults& known,
             const std::vector<regression::Exclusion>& excluded, Faults& faults)
      : store_(store), device_(device), memory_(memory), known_(known), excluded_(excluded), faults_(faults) {}

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
        recordings.push_back(pinned_recording(recording, device_, known_, store_, faults_));
      }
    }
    return Json{{"label", arm.label}, {"recordings", std::move(recordings)}};
  }

  /// The releases of earlier runs, oldest first, as far as their recordings are there, have results and are in neither
  /// arm. Errors: those of the store.
  [[nodiscard]] Result<Json> earlier_releases(const WrittenArm& baseline, const WrittenArm& candidate) const {
    Json releases = Json::array();
    for (const std::string& label : memory_.history().releases(baseline.label, candidate.label)) {
      auto found = memory_.recordings(label, "/inputs/history");
      if (!found) {
        return fail(found.error());
      }
      WrittenArm release{label, "", {}};
      for (WrittenRecording& recording : *found) {
        const auto same = [&](const WrittenRecording& other) { return other.recording == recording.recording; };
        const bool elsewhere = std::any_of(baseline.recordings.begin(), baseline.recordings.end(), same) ||
                               std::any_of(candidate.recordings.begin(), candidate.recordings.end(), same);
        if (!elsewhere && known_.results.contains(recording.recording) && !is_excluded(recording.recording)) {
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
  const DeviceResults& known_;
  const std::vector<regression::Exclusion>& excluded_;
  Faults& faults_;
};

/// In order, for one text whatever the order of the recordings.
std::vector<std::string> ids_in_both(const Json& one, const Json& other) {
  const std::vector<std::string> first = regressed_ids(one);
  const std::vector<std::string> second = regressed_ids(other);
  const std::set<std::string> left(first.begin(), first.end());
  const std::set<std::string> right(second.begin(), second.end());
  std::vector<std::string> both;
  std::set_intersection(left.begin(), left.end(), right.begin(), right.end(), std::back_inserter(both));
  return both;
}

std::vector<std::string> labels_of(const Json& arms) {
  std::vector<std::string> labels;
  for (const Json& arm : arms) {
    labels.push_back(arm["label"].get<std::string>());
  }
  return labels;
}

}  // namespace

Result<Json> pinned_inputs(WrittenRegression& written, const Device& device, const RegressionMemory& memory,
                           const DeviceResults& known, Store& store, Faults& faults) {
  const PinnedArms arms(store, device, memory, known, written.excluded, faults);
  for (const auto& [arm, pointer] :
       {std::pair{&written.baseline, "/inputs/baseline"}, {&written.candidate, "/inputs/candidate"}}) {
    if (Status found = arms.complete(*arm, pointer); !found) {
      return fail(found.error());
    }
  }
  const std::string& label = written.candidate.label;
  if (const Status differ = check_arms_differ(written.baseline.label, label); !differ) {
    faults.add("/inputs/candidate", differ.error());
  }
  Json inputs{{"device", device.id},
              {"device_name", device.name},
              {"baseline", arms.pinned(written.baseline)},
              {"candidate", arms.pinned(written.candidate)},
              {"history", Json::array()},
              {"excluded", Json::array()}};
  if (faults.none()) {
    for (const std::string& id : ids_in_both(inputs["baseline"], inputs["candidate"])) {
      faults.add("/inputs/candidate", ErrorCode::InvalidArgument, "The recording " + id + " is in both arms.");
    }
  }
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
      inputs["before_baseline"] = memory.history().before(labels_of(*releases), written.baseline.label);
      inputs["previous"] = releases->size() - 1;
    }
    inputs["history"] = std::move(*releases);
  }
  for (const regression::Exclusion& exclusion : written.excluded) {
    inputs["excluded"].push_back(Json{{"recording", exclusion.recording}, {"reason", exclusion.reason}});
  }
  return inputs;
}

}  // namespace driftlab::server
