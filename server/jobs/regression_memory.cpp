#include "server/jobs/regression_memory.hpp"

#include "core/signal/text.hpp"
#include "schema/json/recording_tags.hpp"
#include "server/jobs/every_row.hpp"
#include "server/store/damaged_row.hpp"

namespace driftlab::server {
namespace {

WrittenRecording labelled_recording(const Recording& row, const std::string& pointer) {
  Faults ignored;
  WrittenRecording recording;
  recording.recording = row.id;
  recording.pointer = pointer;
  const auto tags = parse_json(row.tags_json);
  const RecordingTags read = tags ? recording_tags_from_json(*tags, "", ignored) : RecordingTags{};
  recording.session = read.session;
  recording.recorded_at = read.recorded_at;
  return recording;
}

}  // namespace

std::vector<std::string> regressed_ids(const Json& arm) {
  std::vector<std::string> ids;
  for (const Json& recording : arm["recordings"]) {
    ids.push_back(recording["recording"].get<std::string>());
  }
  return ids;
}

Result<RegressionMemory> RegressionMemory::of(Store& store, const Device& device) {
  RegressionMemory memory(store, device);
  JobFilter filter;
  filter.kind = std::string(kRegressKind);
  filter.input_device = device.id;
  const auto note = [&](const Json& arm) {
    const std::string label = arm.value("label", "");
    if (label.empty()) {
      return;
    }
    memory.history_.name(label);
    for (const std::string& id : regressed_ids(arm)) {
      memory.named_[label].insert(id);
    }
  };
  std::string damaged;
  const Status read = for_each_row([&](const Page& page) { return store.jobs(filter, page); },
                                   [&](const Job& job) {
                                     if (job.is_damaged) {
                                       damaged = job.id;
                                       return;
                                     }
                                     const auto request = parse_json(job.request_json);
                                     const bool stands = job.state == JobState::Queued ||
                                                         job.state == JobState::Running ||
                                                         job.state == JobState::Succeeded;
                                     if (!stands || !request) {
                                       return;
                                     }
                                     const Json& inputs = (*request)["inputs"];
                                     for (const Json& release : inputs.value("history", Json::array())) {
                                       note(release);
                                     }
                                     note(inputs["baseline"]);
                                     note(inputs["candidate"]);
                                     const std::string candidate = inputs["candidate"].value("label", "");
                                     if (memory.first_baseline_.empty()) {
                                       memory.first_baseline_ = inputs["baseline"].value("label", "");
                                       memory.first_settings_ = (*request)["parameters"];
                                     }
                                     if (job.state == JobState::Succeeded) {
                                       memory.succeeded_.push_back(job.id);
                                     }
                                     memory.history_.add_run(candidate, regressed_ids(inputs["candidate"]));
                                   });
  if (read && !damaged.empty()) {
    return fail(damaged_row("jobs", "job", damaged));
  }
  return read ? Result<RegressionMemory>(std::move(memory)) : fail(read.error());
}

Result<std::string> RegressionMemory::anchor() const {
  const auto moved = store_->anchors(device_.id, {.after = "", .limit = 1, .order = PageOrder::NewestFirst});
  if (!moved) {
    return fail(moved.error());
  }
  return moved->empty() ? first_baseline_ : moved->front().label;
}

Result<std::optional<regression::Settings>> RegressionMemory::kept_settings() const {
  const auto moved = store_->anchors(device_.id, {.after = "", .limit = 1, .order = PageOrder::NewestFirst});
  if (!moved) {
    return fail(moved.error());
  }
  Json kept = first_settings_;
  if (!moved->empty()) {
    const std::string& text = moved->front().settings_json;
    const auto document = text.empty() ? Result<Json>(Json(nullptr)) : parse_json(text);
    if (!document) {
      return fail(document.error());
    }
    kept = *document;
  }
  if (!kept.is_object()) {
    return std::optional<regression::Settings>();
  }
  Faults faults;
  WrittenRegression read;
  regression_settings_from_json(kept, "", read, faults);
  return faults.none() ? std::optional(read.settings) : std::nullopt;
}

Result<std::string> RegressionMemory::last_pass() const {
  for (auto id = succeeded_.rbegin(); id != succeeded_.rend(); ++id) {
    const auto text = store_->result_document(*id);
    if (!text && text.error().code == ErrorCode::NotFound) {
      continue;  // it went with a recording that was deleted
    }
    const auto document = text ? parse_json(*text) : fail(text.error());
    if (!document) {
      return fail(document.error());
    }
    const Json label = (*document)["arms"]["candidate"]["label"];
    if ((*document)["verdict"] == "pass" && label.is_string()) {
      return label.get<std::string>();
    }
  }
  return std::string();
}

Result<std::vector<WrittenRecording>> RegressionMemory::recordings(const std::string& label,
                                                                   const std::string& pointer) const {
  std::vector<WrittenRecording> found;
  RecordingFilter filter;
  filter.device_id = device_.id;
  for (const std::string_view word : split(label, ',')) {
    filter.labels.emplace_back(word);
  }
  const Status read = for_each_row([&](const Page& page) { return store_->recordings(filter, page); },
                                   [&](const Recording& row) { found.push_back(labelled_recording(row, pointer)); });
  if (!read) {
    return fail(read.error());
  }
  const auto before = named_.find(label);
  if (!found.empty() || before == named_.end()) {
    return found;
  }
  for (const std::string& id : before->second) {
    const auto row = store_->recording(id);
    if (row) {
      found.push_back(labelled_recording(*row, pointer));
    } else if (row.error().code != ErrorCode::NotFound) {
      return fail(row.error());
    }
  }
  return found;
}

Result<std::string> RegressionMemory::unknown_label(const std::string& label) const {
  std::set<std::string> known(history_.labels().begin(), history_.labels().end());
  RecordingFilter filter;
  filter.device_id = device_.id;
  const Status read = for_each_row(
      [&](const Page& page) { return store_->recordings(filter, page); },
      [&](const Recording& row) {
        Faults ignored;
        const auto tags = parse_json(row.tags_json);
        for (const std::string& word : label_words(tags ? recording_tags_from_json(*tags, "", ignored).labels
                                                        : std::map<std::string, std::string>())) {
          known.insert(word);
        }
      });
  if (!read) {
    return fail(read.error());
  }
  std::string list;
  for (const std::string& word : known) {
    list += (list.empty() ? "" : ", ") + word;
  }
  return "No recording of " + device_.name + " has the label " + label +
         "; labels of this device: " + (list.empty() ? "none" : list) + ".";
}

}  // namespace driftlab::server
