#include "clients/cli/progress.hpp"
#include "clients/cli/regress_input.hpp"
#include "clients/cli/regress_outputs.hpp"
#include "clients/cli/remote_upload.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

namespace driftlab::cli {
namespace {

constexpr double kUploaded = 0.2;  ///< shares of the progress bar
constexpr double kAnalysis = 0.95;

/// The labels of `firmware=1.5.0,board=b`; empty where it is none.
tl::expected<std::map<std::string, std::string>, Failure> labels_of(const std::string& label) {
  if (label.empty()) {
    return std::map<std::string, std::string>{};
  }
  auto labels = parse_labels(label);
  return labels ? tl::expected<std::map<std::string, std::string>, Failure>(std::move(*labels))
                : tl::unexpected(Failure{labels.error(), Exit::BadInput});
}

std::string label_text(const std::map<std::string, std::string>& labels) {
  std::string text;
  for (const std::string& word : label_words(labels)) {
    text += (text.empty() ? "" : ",") + word;
  }
  return text;
}

/// One line for each label under which the daemon has files of an arm already.
void say_kept(const std::vector<KeptRecording>& kept, const std::string& arm, std::size_t of) {
  std::map<std::string, std::size_t> counts;
  for (const KeptRecording& recording : kept) {
    ++counts[label_text(recording.labels)];
  }
  for (const auto& [label, count] : counts) {
    std::fprintf(stderr, "driftlab: %s: the bytes of %s are stored already %s and are compared as they are.\n",
                 arm.c_str(),
                 count == of ? with_count(of, "file").c_str()
                             : (std::to_string(count) + " of " + with_count(of, "file")).c_str(),
                 label.empty() ? "without a label" : ("under " + label).c_str());
  }
}

/// Sends the files of a run and has each characterised; arms then name what the daemon has.
class ArmSender {
 public:
  ArmSender(HttpClient& client, const WrittenRegression& run, const RegressFlags& flags, std::size_t files)
      : client_(client), device_(run.device), models_(flags.models), lines_(flags.file), files_(files) {}

  /// The arm as the job's request has it. With labels it is all recordings that have them, those sent now among them.
  /// What the daemon has under other labels keeps them, and the arm is then the files that it names. Where nothing has
  /// the arm's own label it goes by that of its newest recording: a label that nothing has would be a release without
  /// recordings, and a look at it another look at the same ones.
  [[nodiscard]] tl::expected<Json, Failure> sent(const WrittenArm& arm, const std::string& name) {
    if (!arm.special.empty()) {
      return Json(arm.special);
    }
    auto labels = labels_of(arm.label);
    if (!labels) {
      return tl::unexpected(labels.error());
    }
    kept_.clear();
    Json document = Json::object();
    Json recordings = Json::array();
    bool label_says_all = true;  // what was sent now has it; what the request says of a recording beside needs the list
    for (const WrittenRecording& recording : arm.recordings) {
      label_says_all = label_says_all && !recording.file.empty() && recording.stated.empty();
      auto one = sent(recording, *labels);
      if (!one) {
        return tl::unexpected(one.error());
      }
      if (std::find(recordings.begin(), recordings.end(), *one) == recordings.end()) {  // two files of the same bytes
        recordings.push_back(std::move(*one));
      }
    }
    if (!kept_.empty()) {
      say_kept(kept_, name, arm.recordings.size());
      label_says_all = false;
      if (!labels->empty() && kept_.size() == arm.recordings.size()) {
        const KeptRecording* newest = &kept_.front();
        for (const KeptRecording& one : kept_) {
          newest = one.id > newest->id ? &one : newest;  // ids begin with the time
        }
        *labels = newest->labels;
      }
    }
    if (!labels->empty()) {
      document["labels"] = *labels;
    }
    if (labels->empty() || !label_says_all) {
      document["recordings"] = std::move(recordings);
    }
    return document;
  }

 private:
  [[nodiscard]] tl::expected<Json, Failure> sent(const WrittenRecording& recording,
                                                 const std::map<std::string, std::string>& labels) {
    Json document = Json::object();
    if (!recording.recording.empty()) {
      document["recording"] = recording.recording;
    } else if (!recording.file.empty()) {
      auto inputs = described_file(recording.file, recording.spec, lines_);
      if (!inputs) {
        return tl::unexpected(Failure{inputs.error(), Exit::BadInput});
      }
      inputs->device = device_;
      auto described = with_stored_calibrations(client_, *inputs);
      if (!described) {
        return tl::unexpected(described.error());
      }
      InputFile& file = described->front();
      // A name that is only the path differs from machine to machine; the daemon would take it for other metadata.
      if (file.spec.id.ends_with(recording.file) || recording.file.ends_with(file.spec.id)) {
        file.spec.id = file.path.filename().string();
      }
      const double before = kUploaded * static_cast<double>(done_) / static_cast<double>(files_);
      auto id =
          upload_file(client_, device_, file, {labels, recording.session, recording.recorded_at}, [&](double fraction) {
            bar_.show("upload " + recording.file, before + kUploaded * fraction / static_cast<double>(files_));
          });
      if (!id) {
        auto kept = kept_under_other_labels(client_, id.error(), labels);
        if (!kept) {
          return tl::unexpected(kept.error());
        }
        id = Json(kept->id);
        kept_.push_back(std::move(*kept));
      }
      if (auto analysed = characterise(*id); !analysed) {
        return tl::unexpected(analysed.error());
      }
      document["recording"] = std::move(*id);
    } else {
      return tl::unexpected(Failure{
          {ErrorCode::InvalidArgument,
           "The result " + recording.result + " lies on this machine: compare it without --server, or name its file.",
           {{"path", recording.result}}},
          Exit::BadInput});
    }
    for (const auto& [name, text] :
         {std::pair{"session", &recording.session}, {"recorded_at", &recording.recorded_at}}) {
      if (!text->empty()) {
        document[name] = *text;
      }
    }
    add_stated_facts(recording.stated, document);
    return document;
  }

  /// One job for each recording: the same recording is then the same job in every run.
  [[nodiscard]] tl::expected<void, Failure> characterise(const Json& id) {
    Json request{{"kind", "characterise"}, {"inputs", {{"recordings", Json::array({id})}}}};
    if (!models_.empty()) {
      request["parameters"] = Json{{"models", models_}};
    }
    const double step = (kAnalysis - kUploaded) / static_cast<double>(files_);
    const double before = kUploaded + step * static_cast<double>(done_);
    ++done_;
    auto job = succeeded_job(client_, request, bar_, before, before + step);
    return job ? tl::expected<void, Failure>() : tl::unexpected(job.error());
  }

  HttpClient& client_;
  std::string device_;
  std::vector<std::string> models_;
  FileFlags lines_;
  std::size_t files_;
  std::size_t done_ = 0;
  std::vector<KeptRecording> kept_;  ///< of the arm that is being sent
  ProgressBar bar_;
};

std::size_t files_in(const WrittenRegression& run) {
  std::size_t files = run.baseline.recordings.size() + run.candidate.recordings.size();
  for (const WrittenArm& release : run.history) {
    files += release.recordings.size();
  }
  return std::max<std::size_t>(files, 1);
}

/// The request of the job that compares.
tl::expected<Json, Failure> request_of(HttpClient& client, const WrittenRegression& run, const RegressFlags& flags) {
  ArmSender sender(client, run, flags, files_in(run));
  Json inputs{{"device", run.device}};
  for (const auto& [name, arm] : {std::pair{"baseline", &run.baseline}, {"candidate", &run.candidate}}) {
    auto sent = sender.sent(*arm, name);
    if (!sent) {
      return tl::unexpected(sent.error());
    }
    inputs[name] = std::move(*sent);
  }
  for (const WrittenArm& release : run.history) {
    auto sent = sender.sent(release, "history");
    if (!sent) {
      return tl::unexpected(sent.error());
    }
    inputs["history"].push_back(std::move(*sent));
  }
  for (const regression::Exclusion& exclusion : run.excluded) {
    inputs["excluded"].push_back(Json{{"recording", exclusion.recording}, {"reason", exclusion.reason}});
  }
  const Json all = to_json(run.settings, run.looks);
  Json parameters = Json::object();  // what is not asked for the daemon knows, with what the anchor keeps
  for (const auto& [name, value] : all.items()) {
    if (run.stated.contains(name)) {
      parameters[name] = value;
    }
  }
  return Json{{"kind", "regress"}, {"inputs", std::move(inputs)}, {"parameters", std::move(parameters)}};
}

/// The forms of a run that a daemon has.
class StoredRun {
 public:
  StoredRun(HttpClient client, const std::string& id) : client_(std::move(client)), target_("/v1/regressions/" + id) {}

  [[nodiscard]] Result<std::string> get(const std::string& more, const std::string& accept) {
    auto reply = client_.get(target_ + more, accept);
    if (!reply) {
      return fail(reply.error());
    }
    return reply->status == 200 ? Result<std::string>(std::move(reply->body)) : fail(refused(*reply).value().error);
  }

  /// The page with the figure where it lies, or without it.
  [[nodiscard]] Result<std::string> page(const std::string& figure) {
    auto text = get("", "text/markdown");
    const std::string place = "(" + target_ + "/figure)";
    const std::size_t at = text ? text->find(place) : std::string::npos;
    if (at == std::string::npos) {
      return text;
    }
    if (!figure.empty()) {
      text->replace(at, place.size(), "(" + figure + ")");
    } else {
      const std::size_t line = text->rfind('\n', at) + 1;
      text->erase(line, text->find('\n', at) + 1 - line);
    }
    return text;
  }

 private:
  HttpClient client_;
  std::string target_;
};

/// Makes a label the anchor of its device.
tl::expected<Exit, Failure> accept_there(HttpClient& client, const RegressFlags& flags) {
  if (flags.reason.empty() || flags.file.device.empty()) {
    return unable({ErrorCode::InvalidArgument, "--accept with --server needs --device NAME and --reason TEXT.", {}});
  }
  WrittenRegression run;
  if (auto read = read_settings(flags, run); !read) {
    return unable(read.error());
  }
  Json anchor{{"device", flags.file.device}, {"label", flags.accept}, {"reason", flags.reason}};
  const Json all = to_json(run.settings, run.looks);
  for (const std::string& name : run.stated) {
    if (all.contains(name)) {
      anchor["settings"][name] = all[name];
    }
  }
  const auto moved = post_for_id(client, "/v1/regression-anchors", anchor, "an anchor");
  if (!moved) {
    return tl::unexpected(moved.error());
  }
  std::printf("The baseline is %s from now on: %s\n", flags.accept.c_str(), flags.reason.c_str());
  return Exit::Success;
}

}  // namespace

tl::expected<Exit, Failure> regress_there(const RegressFlags& flags) {
  if (!flags.state.empty()) {
    return unable({ErrorCode::InvalidArgument, "The daemon keeps anchor, looks and history: leave --state out.", {}});
  }
  auto client = HttpClient::to(flags.server);
  if (!client) {
    return unable(client.error());
  }
  if (!flags.accept.empty()) {
    return accept_there(*client, flags);
  }
  auto run = written_run(flags);
  if (!run) {
    return unable(run.error());
  }
  if (flags.run.empty() && flags.file.device.empty()) {
    return unable(
        {ErrorCode::InvalidArgument, "Name the device whose recordings the daemon keeps: --device NAME.", {}});
  }
  if (!flags.baseline_label.empty()) {
    run->baseline.special.clear();  // the daemon knows which recordings have it
  }
  if (run->candidate.recordings.empty() && run->candidate.label.empty()) {
    return unable({ErrorCode::InvalidArgument,
                   "A run needs a candidate: --candidate FILE..., --candidate-label, or a run.json that names one.",
                   {}});
  }
  const auto request = request_of(*client, *run, flags);
  if (!request) {
    return tl::unexpected(request.error());
  }
  ProgressBar bar;
  const auto job = succeeded_job(*client, *request, bar, kAnalysis);
  if (!job) {
    return tl::unexpected(job.error());
  }
  StoredRun stored(*client, *job);
  const auto body = stored.get("", "application/json");
  const auto document = body ? parse_json(*body) : fail(body.error());
  if (!document) {
    return unable(document.error(), Exit::ServerOrJob);
  }
  const std::string verdict = document->value("verdict", "");
  RunForms forms;
  forms.verdict = verdict == "pass"   ? regression::Verdict::Pass
                  : verdict == "fail" ? regression::Verdict::Fail
                                      : regression::Verdict::Inconclusive;
  const std::string open = run->inconclusive == Inconclusive::Pass ? "?inconclusive=pass" : "";
  forms.document = [&] { return document->dump(2) + "\n"; };
  forms.text = [&] { return stored.get("", "text/plain"); };
  forms.junit = [&] { return stored.get("/junit" + open, "text/xml"); };
  forms.markdown = [&](const std::string& figure) { return stored.page(figure); };
  forms.figure = [&] { return stored.get("/figure", "image/svg+xml"); };
  forms.badge = [&] { return stored.get("/badge", "image/svg+xml"); };
  return finish_run(flags, forms, run->inconclusive);
}

}  // namespace driftlab::cli
