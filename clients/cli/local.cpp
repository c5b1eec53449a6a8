#include "clients/cli/analysis.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"
#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"

#include <utility>

namespace driftlab::cli {

tl::expected<Json, Failure> characterise_here(const Inputs& inputs, const CharacteriseOptions& options) {
  auto files = LocalFiles::of(inputs);
  if (!files) {
    return tl::unexpected(Failure{files.error(), Exit::BadInput});
  }
  ProgressBar bar;
  const RunControl work{interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, 0.9 * f); }};
  const auto found = characterise(**files, options, work);
  if (!found) {
    const Exit exit = found.error().code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
    return tl::unexpected(Failure{found.error(), exit});
  }
  std::vector<Json> recordings;
  for (const CharacterisedRecording& recording : *found) {
    recordings.push_back(to_json(recording));
  }
  Json document = characterisation_document(std::move(recordings));
  document["study"] = inputs.study;
  const RunControl control{interrupt_token(),
                           [&](std::string_view stage, double f) { bar.show(stage, 0.9 + 0.1 * f); }};
  const auto summary = summarise_campaign(inputs.device, sensors_of(*found), control);
  if (!summary) {
    const Exit exit = summary.error().code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
    return tl::unexpected(Failure{summary.error(), exit});
  }
  add_summary(document, *summary);
  return document;
}

namespace {

/// What is true of the recordings, a line each: it was in the document alone, and a frozen sensor was tabled unmarked.
std::string notes_of(const Json& document) {
  std::string text;
  const auto add = [&](const std::string& whose, const Json& sentences) {
    for (const Json& sentence : sentences) {
      text += "! " + whose + ": " + sentence.get<std::string>() + "\n";
    }
  };
  for (const Json& recording : document.at("recordings")) {
    const auto id = recording.at("id").get<std::string>();
    add(id, recording.at("quality").at("notes"));
    for (const Json& channel : recording.at("channels")) {
      add(id + ", " + channel.at("channel").get<std::string>(), channel.at("warnings"));
    }
  }
  return text;
}

}  // namespace

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
  return text + notes_of(document);
}

}  // namespace driftlab::cli
