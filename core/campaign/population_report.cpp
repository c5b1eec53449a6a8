#include "core/campaign/population_report.hpp"

#include "core/datasheet/data_sheet.hpp"
#include "core/signal/sort_keeping_ties.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>

namespace driftlab {
namespace {

constexpr std::array kParameters{"N", "B", "K"};

/// What a table has of one parameter under one condition.
ReportedValue estimate_of(const ParameterTable& table, const TableRow& row, const std::string& parameter) {
  if (parameter == "N") {
    return row.density.estimate;
  }
  const auto column = std::find_if(table.columns.begin(), table.columns.end(),
                                   [&](const TableColumn& one) { return one.key == parameter; });
  return column == table.columns.end() ? ReportedValue{{}, {}, {}, "", "Not estimated."}
                                       : row.cells[static_cast<std::size_t>(column - table.columns.begin())].estimate;
}

struct OpenRow {
  PopulationRow row;
  std::vector<DeviceEstimate> devices;
};

void collect(const ParameterTable& table, std::vector<OpenRow>& open) {
  for (const TableRow& shown : table.rows) {
    for (const char* const parameter : kParameters) {
      auto found = std::find_if(open.begin(), open.end(), [&](const OpenRow& one) {
        return one.row.quantity == table.quantity && one.row.axis == table.axis &&
               one.row.condition == shown.condition && one.row.parameter == parameter;
      });
      if (found == open.end()) {
        open.push_back({{table.quantity, table.axis, shown.condition, shown.label, parameter, {}, ""}, {}});
        found = open.end() - 1;
      }
      found->devices.push_back({table.device, estimate_of(table, shown, parameter)});
    }
  }
}

bool stands_before(const OpenRow& a, const OpenRow& b) {
  if (a.row.quantity != b.row.quantity) {
    return a.row.quantity < b.row.quantity;
  }
  if (a.row.axis != b.row.axis) {
    return a.row.axis < b.row.axis;
  }
  return comes_before(a.row.condition, b.row.condition);
}

}  // namespace

PopulationReport describe_populations(const std::string& model, const std::vector<ParameterTable>& tables) {
  PopulationReport report{model, {}, {}};
  std::vector<OpenRow> open;
  for (const ParameterTable& table : tables) {
    if (std::find(report.devices.begin(), report.devices.end(), table.device) == report.devices.end()) {
      report.devices.push_back(table.device);
    }
    collect(table, open);
  }
  sort_keeping_ties(open, stands_before);
  for (OpenRow& one : open) {
    const bool identified = std::any_of(one.devices.begin(), one.devices.end(),
                                        [](const DeviceEstimate& device) { return device.estimate.value.has_value(); });
    if (!identified) {
      continue;
    }
    auto population = describe_population(one.devices);
    if (population) {
      one.row.population = std::move(*population);
    } else {
      one.row.reason = population.error().message;
      for (const DeviceEstimate& device : one.devices) {
        if (!device.estimate.value) {
          one.row.population.left_out.push_back({device.device, device.estimate.reason});
        }
      }
    }
    report.rows.push_back(std::move(one.row));
  }
  return report;
}

bool is_of_model(std::string_view model, std::span<const std::string> hardware) {
  const auto named = sheets_named_in(model);
  return std::any_of(hardware.begin(), hardware.end(), [&](const std::string& text) {
    return lower_case(text) == lower_case(model) || (named.size() == 1 && sheets_named_in(text) == named);
  });
}

}  // namespace driftlab
