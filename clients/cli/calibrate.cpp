#include "core/analysis/calibrate.hpp"

#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/left_out_lines.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "schema/json/calibration.hpp"
#include "schema/text/calibration.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace driftlab::cli {
namespace {

struct CalibrateFlags {
  std::vector<std::string> files;
  FileFlags file;
  CalibrateOptions options;
  bool json = false;
};

Exit run(const CalibrateFlags& flags) {
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return complain(inputs.error());
  }
  auto recordings = LocalFiles::of(*inputs);
  if (!recordings) {
    return complain(recordings.error());
  }
  Result<CalibrationReport> report;
  {
    ProgressBar bar;
    const RunControl control{interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }};
    report = calibrate(**recordings, flags.options, control);
  }
  if (!report) {
    return complain_of_work(report.error());
  }
  const std::string text = flags.json ? to_json(*report).dump(2) + "\n" : calibration_to_text(*report);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return Exit::Success;
}

}  // namespace

void add_calibrate(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "calibrate",
      "Bias, scale factor and misalignment of a triad from a six-position test, or from rests in any attitude");
  const auto flags = std::make_shared<CalibrateFlags>();
  command->add_option("FILE", flags->files, "One study.json of positions, or one recording with rests")->required();
  command->add_option("--rate-hz", flags->file.rate_hz, "Sampling rate; needed without a time column");
  command->add_option("--columns", flags->file.columns, "NAME=QUANTITY:AXIS:UNIT,… e.g. 1=specific_force:x");
  command->add_option("--stream", flags->file.stream,
                      "Of the units of a log or table the one that is meant, as its columns begin, e.g. imu2");
  command->add_option("--condition", flags->file.condition, "Condition of a bare recording")->capture_default_str();
  add_left_out_lines(*command, flags->file);
  command->add_option("--gravity", flags->options.gravity_m_s2, "Local gravity [m/s^2]")->capture_default_str();
  command->add_flag("--misalignment", flags->options.misalignment,
                    "Estimate the misalignment of the axes of known positions too; from rests it always is");
  command->add_flag("--json", flags->json, "Print a document instead of lines");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
