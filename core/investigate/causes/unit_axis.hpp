#pragma once
/// What a finding means to a simulated inertial unit: the last part of a cause's declaration (Cause::in_unit).
#include "core/investigate/causes/cause.hpp"
#include "core/navigate/imu_simulator.hpp"
#include "core/process/model.hpp"

#include <cstddef>
#include <string_view>

namespace driftlab::investigate {

/// One studied axis of the unit while findings are added to it.
struct UnitAxis {
  std::size_t channel = 0;  ///< in the order of ImuSample
  Model model;              ///< its noise
  double bias_sd = 0.0;     ///< of its constant bias [SI]
  ImuHardware* hardware = nullptr;
};

/// Adds a process with the values found, in the cause's order. False where they are outside its bounds.
bool add_process(UnitAxis& axis, std::string_view process, const Evidence& found);

}  // namespace driftlab::investigate
