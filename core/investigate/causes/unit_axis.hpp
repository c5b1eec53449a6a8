#pragma once
/// The effect of findings on a simulated inertial unit (Cause::in_unit).
#include "core/investigate/causes/cause.hpp"
#include "core/process/model.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace driftlab::investigate {

/// One studied axis of the unit, to which findings are added. Properties for which there is no finding are empty.
struct UnitAxis {
  std::size_t channel = 0;  ///< x, y, z of the gyroscopes, then of the accelerometers
  Model model;              ///< its noise
  double bias_sd = 0.0;     ///< of its constant bias [SI]
  std::optional<double> scale_factor = {};
  std::optional<double> range = {};                        ///< the output is clipped at +- this [SI]
  std::optional<double> quantization_step = {};            ///< of the output [SI]
  std::optional<double> bandwidth_hz = {};                 ///< corner of its low-pass
  std::array<std::optional<double>, 3> misalignment = {};  ///< part of the rate about x, y, z
};

/// Adds a process with the values found, in the cause's order. False where they are outside its bounds.
bool add_process(UnitAxis& axis, std::string_view process, const Evidence& found);

}  // namespace driftlab::investigate
