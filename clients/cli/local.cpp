#include "clients/cli/analysis.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"
#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace driftlab::cli {

tl::expected<Json, Failure> characterise_here(const Inputs& inputs, const CharacteriseOptions& options,
                                              ColumnCheck check) {
  auto files = LocalFiles::of(inputs, std::move(check));
  if (!files) {
    return tl::unexpected(Failure{files.error(), Exit::BadInput});
  }
  ProgressBar bar;
  const RunControl control{interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }};
  const auto found = characterise_campaign(**files, options, control);
  if (!found) {
    const Exit exit = found.error().code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
    return tl::unexpected(Failure{found.error(), exit});
  }
  std::vector<Json> recordings;
  for (const CharacterisedRecording& recording : found->recordings) {
    recordings.push_back(to_json(recording));
  }
  Json document = characterisation_document(std::move(recordings));
  document["study"] = inputs.study;
  add_summary(document, found->together);
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

namespace {

/// A sensor axis with what was put together of it, and its tables by both methods.
struct AxisTables {
  const SensorSources* sensor = nullptr;
  std::optional<PooledSensor> pooled;
  std::array<Result<ParameterTable>, 2> tables;  ///< Allan variance, GMWM
};

constexpr std::array kMethods{TableMethod::Av, TableMethod::Gmwm};

Result<AxisTables> axis_tables(const Json& document, const std::string& device,
                               const std::vector<std::string>& hardware, const SensorSources& sensor) {
  auto found = pooled_of(document, sensor);
  if (!found) {
    return fail(found.error());
  }
  AxisTables axis;
  axis.sensor = &sensor;
  axis.pooled = std::move(*found);
  const PooledSensor* const pooled = axis.pooled ? &*axis.pooled : nullptr;
  const Quantity quantity = parse_quantity(sensor.quantity).value_or(Quantity::Unspecified);
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    axis.tables[m] = build_parameter_table({device, quantity, sensor.axis, kMethods[m], "", std::nullopt, hardware},
                                           sensor.sources, pooled);
  }
  return axis;
}

/// Axes of one sensor from here on whose tables have one row each under one condition: they make one table.
std::size_t alike(const std::vector<AxisTables>& axes, std::size_t from, std::size_t method) {
  std::size_t count = 0;
  for (std::size_t i = from; i < axes.size(); ++i) {
    const auto& table = axes[i].tables[method];
    const auto& first = axes[from].tables[method];
    const bool one = table && table->rows.size() == 1 && table->quantity == first->quantity &&
                     table->rows.front().label == first->rows.front().label;
    if (!one) {
      break;
    }
    ++count;
  }
  return count;
}

std::string one_axis_text(const AxisTables& axis) {
  std::string text;
  for (const auto& table : axis.tables) {
    text += table ? table_to_text(*table, false) + "\n" : table.error().message + "\n\n";
    if (table && axis.pooled) {
      text += trends_to_text(build_trends(*table)) + "\n";
    }
  }
  if (axis.pooled && axis.pooled->structure) {
    text += axis.pooled->structure->statement + "\n\n";
  }
  return text;
}

}  // namespace

Result<std::string> tables_of(const Json& document, const std::string& device,
                              const std::vector<std::string>& hardware) {
  const auto sensors = sensors_of(document);
  if (!sensors) {
    return fail(sensors.error());
  }
  std::vector<AxisTables> axes;
  for (const SensorSources& sensor : *sensors) {
    auto axis = axis_tables(document, device, hardware, sensor);
    if (!axis) {
      return fail(axis.error());
    }
    axes.push_back(std::move(*axis));
  }
  std::string text;
  for (std::size_t i = 0; i < axes.size();) {
    const std::size_t count = std::min(alike(axes, i, 0), alike(axes, i, 1));
    if (count < 2) {
      text += one_axis_text(axes[i++]);
      continue;
    }
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      std::vector<ParameterTable> tables;
      for (std::size_t k = i; k < i + count; ++k) {
        tables.push_back(*axes[k].tables[m]);
      }
      text += axes_to_text(tables) + "\n";
    }
    i += count;
  }
  return text + notes_of(document) + (axes.empty() ? "" : table_legend());
}

}  // namespace driftlab::cli
