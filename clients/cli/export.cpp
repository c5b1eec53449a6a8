#include "schema/text/export.hpp"

#include "clients/cli/analysis.hpp"
#include "clients/cli/http_client.hpp"
#include "clients/cli/left_out_lines.hpp"
#include "clients/cli/print_answer.hpp"
#include "core/export/exportable_columns.hpp"
#include "core/export/imu_noise.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

namespace driftlab::cli {
namespace {

struct ExportFlags {
  std::vector<std::string> files;
  FileFlags file;
  std::string target;
  std::string server;
  std::string output;
  bool list = false;
};

/// A characterisation document, where the one file named is one.
std::optional<Json> as_characterisation(const std::vector<std::string>& files) {
  if (files.size() != 1 || !files.front().ends_with(".json")) {
    return std::nullopt;
  }
  const std::ifstream stream(files.front(), std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  auto document = parse_json(text.str());
  return document && is_characterisation(*document) ? std::optional(std::move(*document)) : std::nullopt;
}

/// Whether something of a recording can be exported, before minutes are spent on its columns. A calibration gives
/// readings the unit that their columns lack: such files are not asked.
Status check_columns(const RecordingSpec& spec, const ColumnNames& names) {
  const auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  std::vector<ExportColumn> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto& role = (*roles)[i]) {
      columns.push_back({names[i], role->quantity, role->axis, role->unit.value_or(Unit{}).dimension});
    }
  }
  return check_exportable(columns);
}

/// Why there is nothing to export though there are axes.
std::string why_no_density(const ImuNoise& imu) {
  const AxisNoise& axis = (imu.gyroscope.axes.empty() ? imu.accelerometer : imu.gyroscope).axes.front();
  return "There is nothing to export, for no axis has a noise density, column " + axis.channel + ": " +
         axis.density.remark;
}

/// A device and its sensor axes.
struct Device {
  std::string name;
  std::vector<SensorSources> sensors;
  std::vector<Remark> remarks;  ///< what must be known of the figures: a unit that looks wrong, a frozen sensor
};

/// What the user named: a characterisation as it stands, recordings characterised now.
tl::expected<Device, Failure> characterised(const ExportFlags& flags) {
  if (auto document = as_characterisation(flags.files)) {
    std::string device = flags.file.device;
    if (device.empty()) {
      device = document->at("recordings").front().value("id", "unnamed");
    }
    auto sensors = sensors_of(*document);
    if (!sensors) {
      return tl::unexpected(Failure{sensors.error(), Exit::BadInput});
    }
    auto remarks = remarks_of(*document);
    if (!remarks) {
      return tl::unexpected(Failure{remarks.error(), Exit::BadInput});
    }
    return Device{std::move(device), std::move(*sensors), std::move(*remarks)};
  }
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return tl::unexpected(Failure{inputs.error(), Exit::BadInput});
  }
  const bool corrected = std::any_of(inputs->files.begin(), inputs->files.end(), [](const InputFile& file) {
    return file.calibration.accelerometer || file.calibration.gyroscope;
  });
  const auto found = characterise_here(*inputs, {}, corrected ? ColumnCheck() : check_columns);
  if (!found) {
    return tl::unexpected(found.error());
  }
  return Device{inputs->device, sensors_of(found->recordings), remarks_of(found->recordings)};
}

Exit run_here(const ExportFlags& flags, const ExportTarget& target) {
  const auto found = characterised(flags);
  if (!found) {
    return complain(found.error().error, found.error().exit);
  }
  const auto imu = imu_noise_of(found->name, found->sensors, {interrupt_token(), {}});
  if (!imu) {
    return complain_of_work(imu.error());
  }
  if (!has_noise(*imu)) {
    return complain({ErrorCode::TooFewSamples, why_no_density(*imu), {}});
  }
  for (const Remark& remark : found->remarks) {
    std::fprintf(stderr, "driftlab: %s: %s\n", remark.whose.c_str(), remark.sentence.c_str());
  }
  for (const std::string& gap : export_gaps(target, *imu)) {
    std::fprintf(stderr, "driftlab: %s\n", gap.c_str());
  }
  return write_text(flags.output, export_to_text(target, *imu));
}

Exit run(const ExportFlags& flags) {
  if (flags.list) {
    return write_text("", export_targets_to_text());
  }
  const auto target = find_export_target(flags.target);
  if (!target) {
    return complain(target.error());
  }
  if (!flags.server.empty()) {
    if (!flags.files.empty() || flags.file.device.empty()) {
      return complain({ErrorCode::InvalidArgument,
                       "With --server name the device (--device NAME) and no files: what it has stored is exported.",
                       {}});
    }
    return print_answer(flags.server,
                        "/v1/exports/" + std::string((*target)->name) + "?device=" + percent_encode(flags.file.device),
                        "text/plain", flags.output);
  }
  if (flags.files.empty()) {
    return complain(
        {ErrorCode::InvalidArgument,
         "Name a recording, a study.json or what `driftlab characterise --json` wrote; or --server and --device.",
         {}});
  }
  return run_here(flags, **target);
}

}  // namespace

void add_export(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "export", "Noise parameters in the file of another program: Kalibr, VINS-Fusion, PX4, Gazebo, ... (--list)");
  const auto flags = std::make_shared<ExportFlags>();
  command->add_option("FILE", flags->files,
                      "Recordings that share the flags below, one study.json, or a document of characterise --json");
  command->add_option("--target", flags->target, "Which program: a name of --list")->capture_default_str();
  command->add_flag("--list", flags->list, "List the programs and end");
  command->add_option("--output", flags->output, "Write to this file instead of the terminal");
  command->add_option("--rate-hz", flags->file.rate_hz, "Sampling rate; needed without a time column");
  command->add_option("--columns", flags->file.columns, "NAME=QUANTITY:AXIS:UNIT,… as for characterise");
  command->add_option("--stream", flags->file.stream,
                      "Of the units of a log or table the one that is meant, as its columns begin, e.g. imu2");
  command->add_option("--condition", flags->file.condition, "static, constant_rate:z:9:deg/s, …")
      ->capture_default_str();
  command->add_option("--device", flags->file.device, "Name of the device; with --server the device to export");
  add_left_out_lines(*command, flags->file);
  command->add_option("--calibration", flags->file.calibration,
                      "Correct the readings by what `driftlab calibrate --json` wrote to this file");
  command->add_option("--server", flags->server, "Export what the daemon at this address has stored of --device");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
