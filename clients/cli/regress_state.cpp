#include "clients/cli/regress_state.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace driftlab::cli {
namespace {

constexpr const char* kFormat = "driftlab-regress-state/1";

Json kept_json(const StoredRecording& recording) {
  Json stored{{"result", recording.document}, {"session", recording.session}, {"recorded_at", recording.recorded_at}};
  add_stated_facts(recording.stated, stored);
  return stored;
}

bool is_text(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string();
}

/// Written by us: everything that is read without asking is there.
bool is_state(const Json& document) {
  const auto is_list = [](const Json& object, const char* name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_array();
  };
  if (!document.is_object() || document.value("format", Json()) != kFormat || !is_list(document, "labels") ||
      !is_list(document, "runs")) {
    return false;
  }
  for (const Json& run : document["runs"]) {
    if (!run.is_object() || !is_text(run, "label") || !is_text(run, "content") || !is_text(run, "verdict")) {
      return false;
    }
  }
  for (const Json& label : document["labels"]) {
    if (!label.is_object() || !is_text(label, "label") || !is_list(label, "recordings")) {
      return false;
    }
    for (const Json& stored : label["recordings"]) {
      const bool whole = stored.is_object() && stored.contains("result") && stored["result"].is_object() &&
                         is_text(stored["result"], "id") && is_text(stored, "session") &&
                         is_text(stored, "recorded_at");
      if (!whole) {
        return false;
      }
    }
  }
  const Json anchor = document.value("anchor", Json());
  return anchor.is_null() || (anchor.is_object() && is_text(anchor, "label"));
}

const Json* find_label(const Json& document, const std::string& label) {
  for (const Json& known : document["labels"]) {
    if (known.value("label", "") == label) {
      return &known;
    }
  }
  return nullptr;
}

/// The ids of a run's candidate as the file keeps them, one text: ids may hold spaces, so it is compared as a whole.
std::string content_of(std::vector<std::string> ids) {
  std::sort(ids.begin(), ids.end());
  std::string content;
  for (const std::string& id : ids) {
    content += (content.empty() ? "" : " ") + id;
  }
  return content;
}

}  // namespace

Result<RegressState> RegressState::open(const std::string& path) {
  RegressState state;
  state.path_ = path;
  state.document_ = Json{{"format", kFormat}, {"anchor", nullptr}, {"labels", Json::array()}, {"runs", Json::array()}};
  if (path.empty() || !std::filesystem::exists(path)) {
    return state;
  }
  const std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  auto document = parse_json(text.str());
  if (!document || !is_state(*document)) {
    return fail(ErrorCode::ParseError, "The file " + path + " is no state of `driftlab regress`.", {{"path", path}});
  }
  state.document_ = std::move(*document);
  return state;
}

std::string RegressState::anchor() const {
  const auto found = document_.find("anchor");
  return found != document_.end() && found->is_object() ? found->value("label", "") : "";
}

void RegressState::set_anchor(const std::string& label, const std::string& reason,
                              const regression::Settings& settings) {
  document_["anchor"] = Json{{"label", label}, {"reason", reason}, {"settings", kept_settings_json(settings)}};
}

std::optional<regression::Settings> RegressState::kept_settings() const {
  const Json anchor = document_.value("anchor", Json());
  if (!anchor.is_object() || !anchor.contains("settings")) {
    return std::nullopt;
  }
  Faults faults;
  WrittenRegression kept;
  regression_settings_from_json(anchor["settings"], "/anchor/settings", kept, faults);
  return faults.none() ? std::optional(kept.settings) : std::nullopt;
}

bool RegressState::has(const std::string& label) const { return find_label(document_, label) != nullptr; }

RegressionHistory RegressState::history() const {
  RegressionHistory history;
  for (const Json& known : document_["labels"]) {
    history.name(known.value("label", ""));
  }
  for (const Json& run : document_["runs"]) {
    history.add_run(run["label"].get<std::string>(), {run["content"].get<std::string>()});
  }
  return history;
}

std::vector<StoredRecording> RegressState::recordings(const std::string& label) const {
  std::vector<StoredRecording> recordings;
  if (const Json* const known = find_label(document_, label)) {
    for (const Json& stored : known->value("recordings", Json::array())) {
      StoredRecording recording;
      recording.document = stored.value("result", Json::object());
      recording.id = recording.document.value("id", "");
      if (const auto here = compared_.find({label, recording.id}); here != compared_.end()) {
        recording.compared = here->second;
      }
      recording.session = stored.value("session", "");
      recording.recorded_at = stored.value("recorded_at", "");
      recording.stated = stated_facts_of(stored);
      recordings.push_back(std::move(recording));
    }
  }
  return recordings;
}

void RegressState::add(const std::string& label, const std::vector<StoredRecording>& recordings) {
  Json& labels = document_["labels"];
  auto known =
      std::find_if(labels.begin(), labels.end(), [&](const Json& each) { return each.value("label", "") == label; });
  if (known == labels.end()) {
    labels.push_back(Json{{"label", label}, {"recordings", Json::array()}});
    known = labels.end() - 1;
  }
  Json& list = (*known)["recordings"];
  for (const StoredRecording& recording : recordings) {
    const auto same = [&](const Json& each) { return each["result"]["id"] == recording.id; };
    if (std::none_of(list.begin(), list.end(), same)) {
      list.push_back(kept_json(recording));
      if (recording.compared) {
        compared_.insert_or_assign({label, recording.id}, *recording.compared);
      }
    }
  }
}

std::string RegressState::last_pass() const {
  std::string label;
  for (const Json& run : document_["runs"]) {
    if (run.value("verdict", "") == "pass") {
      label = run.value("label", "");
    }
  }
  return label;
}

std::size_t RegressState::look(const std::string& label, std::vector<std::string> recordings) const {
  return history().look(label, {content_of(std::move(recordings))});
}

void RegressState::add_run(const std::string& label, std::vector<std::string> recordings, const RegressReport& report) {
  const std::string content = content_of(std::move(recordings));
  document_["runs"].push_back(Json{{"label", label},
                                   {"baseline", report.report.baseline.label},
                                   {"content", content},
                                   {"look", report.look.number},
                                   {"verdict", name_of(report.report.verdict)},
                                   {"sentence", report.report.summary.verdict}});
}

Status RegressState::save() const {
  const std::string fresh = path_ + ".new";
  {
    std::ofstream stream(fresh, std::ios::binary);
    stream << document_.dump(1) << "\n";
    stream.close();
    if (!stream) {
      return fail(ErrorCode::Io, "The file " + fresh + " cannot be written.", {{"path", fresh}});
    }
  }
  std::error_code error;
  std::filesystem::rename(fresh, path_, error);
  if (error) {
    return fail(ErrorCode::Io, "The file " + path_ + " cannot be written.", {{"path", path_}});
  }
  return {};
}

}  // namespace driftlab::cli
