#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/workspace.hpp"
#include "core/read/format.hpp"
#include "core/read/open_recording.hpp"
#include "schema/json/calibrate_recordings.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

struct Flags {
  std::vector<std::string> files;
  FileFlags file;
  CalibrateOptions options;
  bool json = false;
};

Result<CalibrationReport> calibrate(const Inputs& inputs, const CalibrateOptions& options) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  RecordingCalibrator calibrator(inputs.files.size(), options);
  for (const InputFile& file : inputs.files) {
    const auto name_it = [&](Error error) {
      error.message = file.path.string() + ": " + error.message;
      return error;
    };
    auto decoded = decode_file(file.path, workspace->file());
    if (!decoded) {
      return fail(name_it(decoded.error()));
    }
    auto opened = open_recording(workspace->file(), file.spec);
    if (!opened) {
      return fail(name_it(opened.error()));
    }
    if (auto added = calibrator.add(file.spec, opened->view); !added) {
      return fail(name_it(added.error()));
    }
  }
  return calibrator.finish();
}

Exit run(const Flags& flags) {
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return complain(inputs.error());
  }
  auto report = calibrate(*inputs, flags.options);
  if (!report) {
    return complain(report.error());
  }
  const std::string text = flags.json ? report->document.dump(2) + "\n" : report->text;
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_calibrate(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "calibrate",
      "Bias, scale factor and misalignment of a triad from a six-position test, or from rests in any attitude");
  const auto flags = std::make_shared<Flags>();
  command->add_option("FILE", flags->files, "One study.json of positions, or one recording with rests")->required();
  command->add_option("--rate-hz", flags->file.rate_hz, "Sampling rate; needed without a time column");
  command->add_option("--columns", flags->file.columns, "NAME=QUANTITY:AXIS:UNIT,… e.g. 1=specific_force:x");
  command->add_option("--condition", flags->file.condition, "Condition of a bare recording")->capture_default_str();
  command->add_option("--gravity", flags->options.gravity_m_s2, "Local gravity [m/s^2]")->capture_default_str();
  command->add_flag("--misalignment", flags->options.misalignment, "Estimate the misalignment of the axes too");
  command->add_flag("--json", flags->json, "Print a document instead of lines");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
