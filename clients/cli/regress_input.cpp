#include "clients/cli/regress_input.hpp"

#include "clients/cli/json_file.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "core/analysis/characterise.hpp"
#include "core/analysis/compared_recording.hpp"
#include "schema/json/characterise.hpp"

#include <filesystem>
#include <tuple>
#include <utility>

namespace driftlab::cli {
namespace {

/// The arm that files on the command line make.
Result<WrittenArm> arm_of(const std::vector<std::string>& files, const std::string& label, const FileFlags& flags) {
  WrittenArm arm;
  arm.label = label;
  FileFlags described_by = flags;  // lines are left out when a file is read, which is said once
  described_by.skip_lines = 0;
  described_by.comment.clear();
  for (const std::string& file : files) {
    WrittenRecording recording;
    if (file.ends_with(".json")) {
      recording.result = file;
    } else {
      auto described = read_inputs({file}, described_by);
      if (!described) {
        return fail(described.error());
      }
      recording.file = file;
      recording.spec = described->files.front().spec;
      recording.spec.id = label;
      recording.spec.id.append(label.empty() ? "" : "/").append(file);
    }
    arm.recordings.push_back(std::move(recording));
  }
  return arm;
}

Result<std::vector<StoredRecording>> results_in(const WrittenRecording& written) {
  auto document = read_json_file(written.result, "what `driftlab characterise --json` wrote");
  if (!document) {
    return fail(document.error());
  }
  if (!document->is_object() || !document->contains("recordings") || !(*document)["recordings"].is_array()) {
    return fail(ErrorCode::ParseError,
                "The file " + written.result + " is not what `driftlab characterise --json` writes.");
  }
  std::vector<StoredRecording> results;
  for (Json& recording : (*document)["recordings"]) {
    if (!recording.is_object() || !recording.contains("id") || !recording["id"].is_string()) {
      return fail(ErrorCode::ParseError, "A recording in " + written.result + " has no id.");
    }
    StoredRecording& result = results.emplace_back();
    result.id = recording["id"].get<std::string>();
    result.document = std::move(recording);
  }
  return results;
}

}  // namespace

Status read_settings(const RegressFlags& flags, WrittenRegression& into) {
  if (flags.settings.empty()) {
    return {};
  }
  auto document = read_json_file(flags.settings, "the settings of a run");
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  regression_settings_from_json(*document, "", into, faults);
  return faults.none() ? Status{} : fail(in_file(flags.settings, faults.error()));
}

Result<WrittenRegression> written_run(const RegressFlags& flags) {
  WrittenRegression run;
  std::filesystem::path folder;
  if (!flags.run.empty()) {
    auto document = read_json_file(flags.run, "a run.json; recordings go with --baseline and --candidate");
    if (!document) {
      return fail(document.error());
    }
    Faults faults;
    run = regression_from_json(*document, faults);
    if (!faults.none()) {
      return fail(in_file(flags.run, faults.error()));
    }
    folder = std::filesystem::path(flags.run).parent_path();
    std::vector<WrittenArm*> arms{&run.baseline, &run.candidate};
    for (WrittenArm& release : run.history) {
      arms.push_back(&release);
    }
    for (WrittenArm* arm : arms) {
      for (WrittenRecording& recording : arm->recordings) {
        recording.spec.id = recording.spec.id.empty() ? recording.file : recording.spec.id;
        for (std::string* path : {&recording.file, &recording.result, &recording.spec.calibration}) {
          *path = path->empty() ? "" : (folder / *path).string();
        }
      }
    }
  }
  for (const auto& [files, label, arm] : {std::tuple{&flags.baseline, &flags.baseline_label, &run.baseline},
                                          std::tuple{&flags.candidate, &flags.candidate_label, &run.candidate}}) {
    if (!files->empty()) {
      auto made = arm_of(*files, *label, flags.file);
      if (!made) {
        return fail(made.error());
      }
      *arm = std::move(*made);
    }
    arm->label = label->empty() ? arm->label : *label;
  }
  if (flags.run.empty() && flags.baseline.empty()) {
    run.baseline.special = "anchor";
  }
  if (!flags.history.empty()) {
    auto made = arm_of(flags.history, "", flags.file);
    if (!made) {
      return fail(made.error());
    }
    run.history.push_back(std::move(*made));
  }
  run.device = flags.file.device.empty() ? (run.device.empty() ? "device" : run.device) : flags.file.device;
  if (auto read = read_settings(flags, run); !read) {
    return fail(read.error());
  }
  if (!flags.inconclusive.empty()) {
    run.inconclusive = flags.inconclusive == "pass" ? Inconclusive::Pass : Inconclusive::Fail;
  }
  return run;
}

ResultReader::ResultReader(std::vector<std::string> models, FileFlags lines, std::string device, bool kept)
    : models_(std::move(models)), lines_(std::move(lines)), device_(std::move(device)), kept_(kept) {}

Result<std::vector<StoredRecording>> ResultReader::read(const WrittenArm& arm) {
  std::vector<StoredRecording> stored;
  for (const WrittenRecording& written : arm.recordings) {
    auto results = written.result.empty() ? characterised(written) : results_in(written);
    if (!results) {
      return fail(results.error());
    }
    for (StoredRecording& result : *results) {
      result.session = written.session;
      result.recorded_at = written.recorded_at;
      result.stated = written.stated;
      stored.push_back(std::move(result));
    }
  }
  return stored;
}

Result<std::vector<StoredRecording>> ResultReader::characterised(const WrittenRecording& written) {
  if (written.file.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "The recording " + written.recording + " is one of a server: name it with --server.");
  }
  CharacteriseOptions options;
  if (!models_.empty()) {
    options.models = models_;
  }
  auto inputs = described_file(written.file, written.spec, lines_);
  if (!inputs) {
    return fail(inputs.error());
  }
  inputs->device = device_;
  auto files = LocalFiles::of(*inputs);
  if (!files) {
    return fail(files.error());
  }
  ProgressBar bar;
  const RunControl control{interrupt_token(), [&](std::string_view stage, double f) {
                             bar.show(written.spec.id + ": " + std::string(stage), f);
                           }};
  const auto found = characterise(**files, options, control);
  if (!found) {
    return fail(found.error());
  }
  std::vector<StoredRecording> results;
  for (const CharacterisedRecording& recording : *found) {
    StoredRecording& result = results.emplace_back();
    result.id = recording.spec.id;
    result.compared = compared_recording(recording);
    result.document = kept_ ? to_json(recording) : Json(nullptr);
  }
  return results;
}

}  // namespace driftlab::cli
