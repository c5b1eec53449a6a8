#include "clients/cli/cli.hpp"
#include "clients/cli/input.hpp"
#include "clients/cli/workspace.hpp"
#include "core/calibrate/known_positions.hpp"
#include "core/calibrate/still_intervals.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "core/signal/recording_view.hpp"
#include "schema/json/calibration.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>

namespace driftlab::cli {
namespace {

struct Flags {
  std::vector<std::string> files;
  FileFlags file;
  double gravity_m_s2 = kStandardGravity;
  bool misalignment = false;
  bool json = false;
};

/// What is printed: lines for people, and the same as a document.
struct Report {
  std::string text;
  Json document = Json::object();
};

/// The three accelerometer channels, over the rows they share.
std::optional<std::array<std::span<const double>, 3>> accelerometer(const RecordingView& view) {
  std::array<std::span<const double>, 3> triad;
  std::size_t first = 0;
  std::size_t last = static_cast<std::size_t>(-1);
  std::array<const ChannelView*, 3> channels{};
  for (const ChannelView& channel : view.channels) {
    const std::size_t axis = std::string_view("xyz").find(channel.role.axis);
    if (channel.role.quantity == Quantity::SpecificForce && channel.role.axis.size() == 1 && axis < 3) {
      channels[axis] = &channel;
      first = std::max(first, channel.first_row);
      last = std::min(last, channel.first_row + channel.values.size());
    }
  }
  if (last <= first || std::find(channels.begin(), channels.end(), nullptr) != channels.end()) {
    return std::nullopt;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    triad[axis] = channels[axis]->values.subspan(first - channels[axis]->first_row, last - first);
  }
  return triad;
}

/// Calibration from the rests of one recording.
Status calibrate_rests(const RecordingView& view, double gravity_m_s2, Report& report) {
  const auto triad = accelerometer(view);
  if (!triad) {
    return fail(ErrorCode::UnknownColumn,
                "The recording needs specific_force along x, y and z; name the columns with --columns.",
                {{"parameter", "columns"}});
  }
  auto rests = find_still_intervals(*triad, 1.0 / view.window.time.dt_s);
  if (!rests) {
    return fail(rests.error());
  }
  std::vector<Triple> readings;
  for (const StillInterval& rest : *rests) {
    auto mean = triad_mean({(*triad)[0].subspan(rest.first, rest.count), (*triad)[1].subspan(rest.first, rest.count),
                            (*triad)[2].subspan(rest.first, rest.count)});
    if (mean) {
      readings.push_back(mean->mean);
    }
  }
  auto found = calibrate_multi_position(readings, gravity_m_s2);
  if (!found) {
    return fail(found.error());
  }
  report.document["accelerometer"] = to_json(*found);
  report.text = "accelerometer, from " + std::to_string(found->positions) + " positions at rest\n" + to_text(*found);
  return {};
}

/// Calibration of one sensor from known positions; nothing where there are none.
Status calibrate_sensor(const std::string& sensor, std::string_view unit, const std::vector<KnownPosition>& positions,
                        const SixPositionOptions& options, Report& report) {
  const bool moved = std::any_of(positions.begin(), positions.end(),
                                 [](const KnownPosition& position) { return length(position.truth) > 0.0; });
  if (!moved) {
    return {};
  }
  auto found = calibrate_six_positions(positions, options);
  if (!found) {
    Error error = found.error();
    error.message = "The " + sensor + ": " + error.message;
    return fail(std::move(error));
  }
  report.document[sensor] = to_json(*found, unit);
  report.text += sensor + ", from " + std::to_string(positions.size()) + " positions\n" + to_text(*found, unit);
  return {};
}

Result<Report> calibrate(const Inputs& inputs, const Flags& flags) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  KnownPositions positions;
  Report report;
  for (const InputFile& file : inputs.files) {
    const auto name_it = [&](Error error) {
      error.message = file.path.string() + ": " + error.message;
      return error;
    };
    auto decoded = decode_file(file.path, workspace->file());
    if (!decoded) {
      return fail(name_it(decoded.error()));
    }
    auto columns = ColumnFile::open(workspace->file());
    if (!columns) {
      return fail(name_it(columns.error()));
    }
    auto view =
        view_recording(file.spec, columns->names(), columns->rows(), [&](std::size_t i) { return columns->column(i); });
    if (!view) {
      return fail(name_it(view.error()));
    }
    const bool rests = inputs.files.size() == 1 && file.spec.condition.kind != ConditionKind::SixPosition;
    auto status = rests ? calibrate_rests(*view, flags.gravity_m_s2, report)
                        : add_positions(file.spec, *view, flags.gravity_m_s2, positions);
    if (!status) {
      return fail(name_it(status.error()));
    }
  }
  const SixPositionOptions options{flags.misalignment};
  for (const auto& [sensor, unit, list] : {std::tuple{"accelerometer", "m/s^2", &positions.accelerometer},
                                           std::tuple{"gyroscope", "rad/s", &positions.gyroscope}}) {
    if (auto status = calibrate_sensor(sensor, unit, *list, options, report); !status) {
      return fail(status.error());
    }
  }
  if (report.text.empty()) {
    return fail(ErrorCode::TooFewSamples,
                "None of the recordings is a position of a six-position test or a known rate.");
  }
  report.document["notes"] = positions.notes;
  for (const std::string& note : positions.notes) {
    report.text += note + "\n";
  }
  return report;
}

Exit run(const Flags& flags) {
  auto inputs = read_inputs(flags.files, flags.file);
  if (!inputs) {
    return complain(inputs.error());
  }
  auto report = calibrate(*inputs, flags);
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
  command->add_option("--gravity", flags->gravity_m_s2, "Local gravity [m/s^2]")->capture_default_str();
  command->add_flag("--misalignment", flags->misalignment, "Estimate the misalignment of the axes too");
  command->add_flag("--json", flags->json, "Print a document instead of lines");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
