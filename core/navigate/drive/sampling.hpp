#pragma once
/// From stamped rows of an inertial unit to means over equal intervals (spec/drives.md, section 2).
///
/// A filter wants readings[i] to be the mean over an interval of constant length. Rows come with stamps that jitter,
/// and a computer that asks faster than the sensor samples writes some samples twice.
///
/// - Repeats. A row equal to the one before in all six channels is no new data. Where such rows stand alone, are more
///   than one in a thousand and more than twice as many as those of longer runs, the sensor samples more slowly than it
///   is asked: they are dropped, and the others get equal spacing between the first and the last stamp. Longer runs of
///   equal rows are a sensor that is stuck; they are counted and kept.
/// - Stamps. Those of the sensor itself are true: each reading is the mean since the stamp before, and the piecewise
///   constant signal is integrated and differenced on the even grid, so that no angle is lost. Those of a host or of
///   arrival are not true: between two gaps, bridged ones too, their readings get equal spacing.
/// - Gaps. Up to three missing samples are bridged by the reading after them. A longer gap ends the run, and the filter
///   begins another.
///
/// On a car with a consumer unit that is polled at 100 Hz and samples at 97.9 Hz, dropping the repeats alone took
/// errors after 30 s from 55 to 39 m.
#include "core/navigate/drive/document.hpp"

#include <vector>

namespace driftlab::drive {

/// Rows of gyroscope [rad/s] and accelerometer [m/s^2] in one frame, stamped at the end of their interval.
struct SensorLog {
  std::vector<double> time_s;
  std::vector<ImuSample> readings;
};

/// Readings at equal intervals: readings[i] is the mean over the interval that ends at start_s + (i + 1) dt_s.
struct UniformRun {
  double start_s = 0.0;
  double dt_s = 0.0;
  std::vector<ImuSample> readings;
  [[nodiscard]] double end_s() const { return start_s + static_cast<double>(readings.size()) * dt_s; }
};

/// Facts of the unit's rows.
struct SamplingFacts {
  std::size_t rows = 0;
  std::size_t incomplete = 0;       ///< rows left out: a number was missing
  std::size_t repeated = 0;         ///< rows equal to the one before
  std::size_t stuck = 0;            ///< of these, rows in runs of two and more
  std::size_t repeated_stamps = 0;  ///< rows left out: the stamp of the row before
  bool polled_faster = false;       ///< single repeats dropped: the host polls faster than the sensor samples
  double stamped_rate_hz = 0.0;     ///< rows over time
  double sensor_rate_hz = 0.0;      ///< new rows over time
  std::size_t gaps_bridged = 0, samples_bridged = 0;
  std::size_t gaps_splitting = 0;
  double longest_gap_s = 0.0;
  double jitter_s = 0.0;  ///< half the distance of the 5 % and 95 % quantiles of the steps
};

struct SamplingOptions {
  SensorClock clock = SensorClock::Sensor;
  bool repair = true;  ///< false: repeats stay, and stamps are taken as true; what a simulation by the stamps believes
};

/// Even readings, a run for each part between gaps. Runs of less than a second are left out. Errors: TooFewSamples;
/// InconsistentSampling (a median step of zero).
[[nodiscard]] Result<std::vector<UniformRun>> uniform_readings(SensorLog log, const SamplingOptions& options,
                                                               SamplingFacts& facts);

/// The rows of `force` as means over the intervals of `rate`, both stamped at the ends of their intervals: a unit whose
/// accelerometer has a file of its own. Rows of `rate` outside `force` are left out.
[[nodiscard]] SensorLog joined(const std::vector<double>& rate_time_s, const std::vector<Vector3>& rate,
                               const std::vector<double>& force_time_s, const std::vector<Vector3>& force);

}  // namespace driftlab::drive
