#include "clients/cli/analysis.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/workspace.hpp"
#include "core/read/format.hpp"
#include "core/read/open_recording.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise_recording.hpp"
#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"

#include <algorithm>

namespace driftlab::cli {
namespace {

Result<Json> characterise_file(const InputFile& file, const CharacteriseOptions& options, const Workspace& workspace,
                               const RunControl& control) {
  const RunControl decoding{control.stop, [&](std::string_view stage, double f) { control.report(stage, 0.3 * f); }};
  auto decoded = decode_file(file.path, workspace.file(), {}, decoding);
  if (!decoded) {
    return fail(decoded.error());
  }
  auto opened = open_recording(workspace.file(), file.spec);
  if (!opened) {
    return fail(opened.error());
  }
  RecordingView& view = opened->view;
  view.window.quality.notes.insert(view.window.quality.notes.end(), decoded->notes.begin(), decoded->notes.end());
  const RunControl fitting{control.stop,
                           [&](std::string_view stage, double f) { control.report(stage, 0.3 + 0.7 * f); }};
  return characterise_recording(file.spec.id, file.spec, view, file.calibration, options, fitting);
}

}  // namespace

tl::expected<Json, Failure> characterise_here(const Inputs& inputs, const CharacteriseOptions& options) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return tl::unexpected(Failure{workspace.error(), Exit::BadInput});
  }
  ProgressBar bar;
  std::vector<Json> recordings;
  for (const InputFile& file : inputs.files) {
    const auto done = static_cast<double>(recordings.size());
    const RunControl control{interrupt_token(), [&](std::string_view stage, double fraction) {
                               bar.show(stage, 0.9 * (done + fraction) / static_cast<double>(inputs.files.size()));
                             }};
    auto document = characterise_file(file, options, *workspace, control);
    if (!document) {
      Error error = document.error();
      error.message = file.path.string() + ": " + error.message;
      const Exit exit = error.code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
      return tl::unexpected(Failure{std::move(error), exit});
    }
    recordings.push_back(std::move(*document));
  }
  Json document = characterisation_document(std::move(recordings));
  document["study"] = inputs.study;
  const RunControl control{interrupt_token(),
                           [&](std::string_view stage, double f) { bar.show(stage, 0.9 + 0.1 * f); }};
  const auto sensors = sensors_of(document);
  const auto summary = sensors ? summarise_campaign(inputs.device, *sensors, control) : fail(sensors.error());
  if (!summary) {
    const Exit exit = summary.error().code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
    return tl::unexpected(Failure{summary.error(), exit});
  }
  add_summary(document, *summary);
  return document;
}

Result<std::string> tables_of(const Json& document, const std::string& device) {
  std::string text;
  const auto sensors = sensors_of(document);
  if (!sensors) {
    return fail(sensors.error());
  }
  for (const SensorSources& sensor : *sensors) {
    const auto found = pooled_of(document, sensor);
    if (!found) {
      return fail(found.error());
    }
    const PooledSensor* const pooled = *found ? &**found : nullptr;
    for (const TableMethod method : {TableMethod::Av, TableMethod::Gmwm}) {
      const Quantity quantity = parse_quantity(sensor.quantity).value_or(Quantity::Unspecified);
      const auto table = build_parameter_table({device, quantity, sensor.axis, method, ""}, sensor.sources, pooled);
      text += table ? table_to_text(*table) + "\n" : table.error().message + "\n\n";
      if (table && pooled != nullptr) {
        text += trends_to_text(build_trends(*table)) + "\n";
      }
    }
    if (pooled != nullptr && pooled->structure) {
      text += pooled->structure->statement + "\n\n";
    }
  }
  return text;
}

}  // namespace driftlab::cli
