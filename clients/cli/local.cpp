#include "clients/cli/analysis.hpp"
#include "clients/cli/local_files.hpp"
#include "clients/cli/progress.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/characterise.hpp"
#include "schema/text/in_print.hpp"
#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <thread>
#include <utility>

namespace driftlab::cli {

tl::expected<CharacterisedCampaign, Failure> characterise_here(const Inputs& inputs, const CharacteriseOptions& options,
                                                               ColumnCheck check) {
  auto files = LocalFiles::of(inputs, std::move(check));
  if (!files) {
    return tl::unexpected(Failure{files.error(), Exit::BadInput});
  }
  ProgressBar bar;
  Executor executor(std::thread::hardware_concurrency());
  const RunControl control{
      interrupt_token(), [&](std::string_view stage, double f) { bar.show(stage, f); }, {&executor}};
  auto found = characterise_campaign(**files, options, control);
  if (!found) {
    const Exit exit = found.error().code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput;
    return tl::unexpected(Failure{found.error(), exit});
  }
  return std::move(*found);
}

Json as_document(const CharacterisedCampaign& campaign, const Inputs& inputs) {
  std::vector<Json> recordings;
  for (const CharacterisedRecording& recording : campaign.recordings) {
    recordings.push_back(to_json(recording));
  }
  Json document = characterisation_document(std::move(recordings));
  document["study"] = inputs.study;
  add_summary(document, campaign.together);
  return document;
}

TabledCampaign tabled(const CharacterisedCampaign& campaign) {
  return {sensors_of(campaign.recordings), campaign.together.replicates, remarks_of(campaign.recordings)};
}

Result<TabledCampaign> tabled_from_json(const Json& document) {
  auto sensors = sensors_of(document);
  if (!sensors) {
    return fail(sensors.error());
  }
  auto pooled = pooled_sensors_of(document);
  if (!pooled) {
    return fail(pooled.error());
  }
  auto remarks = remarks_of(document);
  if (!remarks) {
    return fail(remarks.error());
  }
  return TabledCampaign{std::move(*sensors), std::move(*pooled), std::move(*remarks)};
}

namespace {

/// A sensor axis with what was put together of it, and its tables by both methods.
struct AxisTables {
  const PooledSensor* pooled = nullptr;
  std::array<Result<ParameterTable>, 2> tables;  ///< Allan variance, GMWM
};

constexpr std::array kMethods{TableMethod::Av, TableMethod::Gmwm};

AxisTables axis_tables(const TabledCampaign& campaign, const std::string& device,
                       const std::vector<std::string>& hardware, const SensorSources& sensor) {
  AxisTables axis;
  axis.pooled = find_pooled(campaign.pooled, sensor);
  const Quantity quantity = parse_quantity(sensor.quantity).value_or(Quantity::Unspecified);
  for (std::size_t m = 0; m < kMethods.size(); ++m) {
    axis.tables[m] = build_parameter_table({device, quantity, sensor.axis, kMethods[m], "", std::nullopt, hardware},
                                           sensor.sources, axis.pooled);
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

ParameterTable named(const ParameterTable& table, TableNames names) {
  return names == TableNames::InPrint ? in_print(table) : table;
}

std::string trends_text(const ParameterTable& table, TableNames names) {
  const TrendTable trends = build_trends(table);
  return trends_to_text(names == TableNames::InPrint ? in_print(trends) : trends);
}

std::string one_axis_text(const AxisTables& axis, TableNames names) {
  std::string text;
  for (const auto& table : axis.tables) {
    text += table ? table_to_text(named(*table, names), false) + "\n" : table.error().message + "\n\n";
    if (table && axis.pooled) {
      text += trends_text(*table, names) + "\n";
    }
  }
  if (axis.pooled && axis.pooled->structure) {
    text += axis.pooled->structure->statement + "\n\n";
  }
  return text;
}

}  // namespace

std::string tables_of(const TabledCampaign& campaign, const std::string& device,
                      const std::vector<std::string>& hardware, TableNames names) {
  std::vector<AxisTables> axes;
  for (const SensorSources& sensor : campaign.sensors) {
    axes.push_back(axis_tables(campaign, device, hardware, sensor));
  }
  std::string text;
  for (std::size_t i = 0; i < axes.size();) {
    const std::size_t count = std::min(alike(axes, i, 0), alike(axes, i, 1));
    if (count < 2) {
      text += one_axis_text(axes[i++], names);
      continue;
    }
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      std::vector<ParameterTable> tables;
      for (std::size_t k = i; k < i + count; ++k) {
        tables.push_back(named(*axes[k].tables[m], names));
      }
      text += axes_to_text(tables) + "\n";
    }
    i += count;
  }
  // It was in the document alone, and a frozen sensor was tabled unmarked.
  for (const Remark& remark : campaign.remarks) {
    text += "! " + remark.whose + ": " + remark.sentence + "\n";
  }
  return text + (axes.empty() ? "" : table_legend());
}

}  // namespace driftlab::cli
