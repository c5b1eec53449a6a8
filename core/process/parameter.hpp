#pragma once
/// What a process declares about each of its parameters.
#include <string_view>

namespace driftlab {

/// How an optimiser or a table should walk a parameter.
enum class ParameterTransform {
  Log,       ///< positive; differences of the logarithm are meaningful
  Identity,  ///< any sign
};

/// One parameter of a process. Its unit is channel unit^`channel_power` * s^(second_power_halves/2)
/// (lab_unit in core/signal/unit.hpp turns that into the unit engineers write).
/// The first parameter of every process is its *level*: all second moments are proportional to its square, which is
/// what makes a sum of processes linear in the squared levels. Parameters after it are *shapes*.
struct ParameterSpec {
  std::string_view name;  ///< as in documents: N, Q, sigma, beta, K, R, B, amplitude, frequency_hz
  int channel_power = 1;
  int second_power_halves = 0;
  double lower = 0.0;  ///< inclusive bound, SI
  double upper = 1e300;
  ParameterTransform transform = ParameterTransform::Log;
};

}  // namespace driftlab
