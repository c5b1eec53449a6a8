#pragma once
/// Whether readings are in the unit that is said of them.
///
/// Two facts do not depend on who recorded: at rest an accelerometer reads one g, whichever way it lies, and a
/// gyroscope shows about the white noise of its data sheet. A unit that is off makes the first wrong by 9.81, 1000 or
/// the counts in one g, the second by 57.3, 1000 or the counts in one deg/s. Only such a factor is told: a sensor that
/// vibrates is not at fault.
///
/// Length: the median of |f| over samples spread over the series, against 1.0 g; another unit is named where it brings
/// that within 10 %. Noise: N from the Allan deviation at about 0.5 s, by the median of the absolute differences of
/// neighbouring means (a knock moves few of them; filters above some Hz do not matter), against the stated N; another
/// unit is named where it brings a ratio beyond 8 within 2.5. Range: a reading beyond the largest full scale.
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
