#pragma once
/// All devices of a model, parameter by parameter: a population (core/campaign/population.hpp) for each sensor axis,
/// condition and parameter.
///
/// Parameters are N, the one density at low frequencies that every row of a table has, and B and K of the regression of
/// the Allan variance (core/campaign/parameter_table.hpp, method av): they mean the same for every device, whichever
/// model describes its curve. A device's recordings of one condition are one estimate.
#include "core/campaign/parameter_table.hpp"
#include "core/campaign/population.hpp"

#include <span>
#include <string>
#include <vector>

namespace driftlab {

struct PopulationRow {
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  Condition condition;
  std::string label;      ///< of the condition, for people
  std::string parameter;  ///< `N`, `B`, `K`
  Population population;  ///< without a mean where `reason` says why
  std::string reason;
};

struct PopulationReport {
  std::string model;
  std::vector<std::string> devices;  ///< with a table, in the order given
  std::vector<PopulationRow> rows;   ///< gyroscope before accelerometer, by axis, condition and parameter
};

/// `tables`: of method av, each of one device and sensor axis. Rows that no device identifies are left out.
[[nodiscard]] PopulationReport describe_populations(const std::string& model,
                                                    const std::vector<ParameterTable>& tables);

/// Whether a device is of the model that a text names: its model or IMU is written so, whatever the case, or both name
/// one known sensor (core/datasheet/data_sheet.hpp). `hardware`: texts that describe the device.
[[nodiscard]] bool is_of_model(std::string_view model, std::span<const std::string> hardware);

}  // namespace driftlab
