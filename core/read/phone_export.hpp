#pragma once
/// A recording from the files that a phone application exports, one per sensor. Internal to core/read.
///
/// phyphox         `Gyroscope.csv`, `Accelerometer.csv` (with gravity), `Linear Accelerometer.csv` (without); headers
///                 `"Time (s)","X (rad/s)",...`.
/// Sensor Logger   `Gyroscope.csv`, `AccelerometerUncalibrated.csv` (with gravity), `TotalAcceleration.csv` (with
///                 gravity), `Accelerometer.csv` (without); headers `time,seconds_elapsed,z,y,x`: the axes by name,
///                 not by place. In rad/s and m/s^2, but the uncalibrated accelerometer of iOS in g, which the size of
///                 its first samples tells.
///
/// Each sensor has a clock of its own rhythm. The gyroscope (else the first sensor) gives rows and time; the rows of a
/// sensor of the same rate (within 1 %) are set beside them, shifted by whole samples to where its start time puts
/// them, never resampled; what is missing at its ends is missing. Sensors of another rate and what the phone computes
/// (gravity, orientation) are left out, and named. Fixes (phone_fixes.hpp) have a time of their own. Rows of two
/// sensors are therefore up to half a sample apart, and more where their clocks drift.
#include "core/read/memory_table.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace driftlab {

/// True for a file whose samples are wanted: a sensor's table, by its path inside the export.
[[nodiscard]] bool is_sensor_file(const std::string& path);

/// The tables as one recording. A single table that is no sensor's is delivered as it is.
/// Errors: NoSamples, UnsupportedFormat (several tables and none is a sensor's), those of the sink.
/// `container`: what held them, for the sentence that says so.
[[nodiscard]] Status deliver_phone_export(std::vector<MemoryTable> tables, const DecodeLimits& limits, ColumnSink& sink,
                                          const std::string& container = "archive");

/// The files of a folder, decoded as those of an archive are. Errors: those of the files; NotFound, Io.
[[nodiscard]] Status decode_folder(const std::filesystem::path& folder, const DecodeLimits& limits, ColumnSink& sink,
                                   const RunControl& control);

}  // namespace driftlab
