#pragma once
/// Are the readings of a sensor in the unit that they are said to be in?
///
/// Two facts hold whoever made the recording. At rest an accelerometer reads 1 g, whichever way it lies, and the white
/// noise of a gyroscope is about that of its data sheet. A wrong unit spoils them by a known factor: 9.81, 1000 or the
/// counts in 1 g for the accelerometer; 57.3, 1000 or the counts in 1 deg/s for the gyroscope. Only such a factor is
/// reported. A sensor that is off by another one may vibrate: its unit is not blamed.
///
/// - Gravity, at rest. The median of |f|, over samples spread evenly over the series, should be 1 g. If it is off by
///   more than 10 %, the unit that brings it within 10 % is named.
/// - Noise of a gyroscope, at rest. The density N is read off the Allan deviation at about 0.5 s, where filters above
///   some Hz do not matter. The deviation is taken from the median of the absolute differences of neighbouring means,
///   of which a knock moves few. If N is off the stated one by a factor of 8 or more, the unit that brings it within
///   2.5 is named.
/// - Range. No reading should exceed the largest full scale of the sensor by more than a quarter.
///
/// Sources: the sensor's data sheet (core/datasheet/data_sheet.hpp), IEEE Std 952 for N = sigma(tau) sqrt(tau).
#include "core/datasheet/data_sheet.hpp"
#include "core/signal/unit.hpp"

#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// Evenly spaced readings of one sensor axis.
struct ObservedChannel {
  std::string column;
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  Unit unit;                        ///< as it was said
  std::span<const double> samples;  ///< in that unit, none missing
};

/// Notes for people, a sentence each; empty where nothing speaks against the units. `hardware`: the texts that describe
/// the device, most telling first. `at_rest`: the condition is static. O(samples).
[[nodiscard]] std::vector<std::string> unit_notes(std::span<const ObservedChannel> channels, double dt_s, bool at_rest,
                                                  std::span<const std::string> hardware);

}  // namespace driftlab
