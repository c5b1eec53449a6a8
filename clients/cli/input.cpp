#include "clients/cli/input.hpp"

#include "clients/cli/json_file.hpp"
#include "clients/cli/left_out_lines.hpp"
#include "core/signal/number.hpp"
#include "schema/json/calibration.hpp"
#include "schema/json/recording_spec.hpp"

#include <utility>

namespace driftlab::cli {
namespace {

/// `static_1.csv.gz` -> `static_1`
std::string stem_of(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.substr(0, name.find('.'));
}

Result<RecordingSpec> spec_from_flags(const FileFlags& flags) {
  RecordingSpec spec;
  if (!flags.rate_hz.empty()) {
    spec.rate_hz = parse_double(flags.rate_hz);
    if (!spec.rate_hz || !is_sampling_rate(*spec.rate_hz)) {
      return fail(ErrorCode::InvalidArgument,
                  "--rate-hz needs a number from 1e-6 to 1e9, not '" + flags.rate_hz + "'.");
    }
  }
  if (!flags.columns.empty()) {
    auto columns = parse_columns(flags.columns);
    if (!columns) {
      return fail(columns.error());
    }
    spec.columns = std::move(*columns);
  }
  auto condition = parse_condition(flags.condition);
  if (!condition) {
    return fail(condition.error());
  }
  spec.condition = *condition;
  spec.stream = flags.stream;
  spec.calibration = flags.calibration;
  return spec;
}

/// Reads the calibrations that the recordings name; names in a study are relative to its folder.
Status read_calibrations(const std::filesystem::path& folder, Inputs& inputs) {
  for (InputFile& file : inputs.files) {
    if (file.spec.calibration.empty()) {
      continue;
    }
    const std::filesystem::path path = folder / file.spec.calibration;
    auto document = read_json_file(path, "a calibration, as `driftlab calibrate --json` writes it");
    if (!document) {
      return fail(document.error());
    }
    Faults faults;
    file.calibration = calibration_from_json(*document, "", faults);
    if (!faults.none()) {
      const Error error = faults.error();
      return fail(error.code, path.string() + ": " + error.message, error.fields);
    }
    file.calibration_document = std::move(*document);
  }
  return {};
}

Result<Inputs> read_study(const std::filesystem::path& path) {
  auto document = read_json_file(path, "a study (JSON), or recordings in place of it");
  if (!document) {
    return fail(document.error());
  }
  Inputs inputs;
  inputs.study = stem_of(path);
  Faults faults;
  ObjectReader reader(*document, "", faults);
  if (const Json* const device = reader.member("device"); device != nullptr && device->is_object()) {
    inputs.device = device->value("id", "");
    for (const char* const member : {"imu", "model"}) {
      if (const Json text = device->value(member, Json(nullptr)); text.is_string()) {
        inputs.hardware.push_back(text.get<std::string>());
      }
    }
  }
  if (const Json* const baseline = reader.member("baseline"); baseline != nullptr) {
    inputs.baseline = *baseline;
  }
  const Json* const recordings = reader.member("recordings");
  if (recordings == nullptr || !recordings->is_array() || recordings->empty()) {
    faults.add("/recordings", ErrorCode::InvalidArgument, "A study needs at least one recording.");
  } else {
    for (std::size_t i = 0; i < recordings->size(); ++i) {
      const std::string pointer = "/recordings/" + std::to_string(i);
      const Json& entry = (*recordings)[i];
      InputFile file;
      file.spec = recording_spec_from_json(entry, pointer, faults);
      ObjectReader named(entry, pointer, faults);
      const std::filesystem::path relative = named.required_text("file");
      file.path = path.parent_path() / relative;
      if (file.spec.id.empty()) {
        file.spec.id = stem_of(relative);
      }
      inputs.files.push_back(std::move(file));
    }
  }
  if (!faults.none()) {
    return fail(in_file(path, faults.error()));
  }
  if (auto read = read_calibrations(path.parent_path(), inputs); !read) {
    return fail(read.error());
  }
  return inputs;
}

}  // namespace

std::string recording_flags(const FileFlags& flags) {
  std::string given;
  for (const auto& [name, is_given] : {std::pair{"--rate-hz", !flags.rate_hz.empty()},
                                       {"--columns", !flags.columns.empty()},
                                       {"--stream", !flags.stream.empty()},
                                       {"--condition", flags.condition != FileFlags{}.condition},
                                       {"--calibration", !flags.calibration.empty()},
                                       {"--skip-lines", flags.skip_lines > 0},
                                       {"--comment", !flags.comment.empty()}}) {
    given += is_given ? (given.empty() ? "" : ", ") + std::string(name) : "";
  }
  return given;
}

Result<Inputs> described_file(const std::filesystem::path& path, const RecordingSpec& spec, const FileFlags& flags) {
  Inputs inputs;
  inputs.files = {{path, spec}};
  if (auto left_out = leave_out_lines(flags, inputs); !left_out) {
    return fail(left_out.error());
  }
  if (auto read = read_calibrations({}, inputs); !read) {
    return fail(read.error());
  }
  return inputs;
}

Result<Inputs> read_inputs(const std::vector<std::string>& names, const FileFlags& flags) {
  if (names.size() == 1 && names.front().ends_with(".json")) {
    if (const std::string given = recording_flags(flags); !given.empty()) {
      return fail(ErrorCode::InvalidArgument,
                  "A study says of each recording what it is: " + given + " cannot stand beside it.");
    }
    auto study = read_study(names.front());
    if (study && !flags.device.empty()) {
      study->device = flags.device;
    }
    if (study) {
      study->hardware.push_back(study->device);
    }
    return study;
  }
  auto spec = spec_from_flags(flags);
  if (!spec) {
    return fail(spec.error());
  }
  Inputs inputs;
  inputs.study = nullptr;
  for (const std::string& name : names) {
    InputFile file{name, *spec};
    file.spec.id = stem_of(file.path);
    inputs.files.push_back(std::move(file));
  }
  if (auto left_out = leave_out_lines(flags, inputs); !left_out) {
    return fail(left_out.error());
  }
  inputs.device = flags.device.empty() ? inputs.files.front().spec.id : flags.device;
  inputs.hardware = {inputs.device};
  if (auto read = read_calibrations({}, inputs); !read) {
    return fail(read.error());
  }
  return inputs;
}

}  // namespace driftlab::cli
