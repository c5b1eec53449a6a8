#pragma once
/// A recording from the named arrays of an .npz or MATLAB file. Internal to core/read.
#include "core/read/memory_table.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// A matrix, column by column.
struct Variable {
  std::string name;
  std::vector<std::vector<double>> columns;
};

/// Delivers the arrays of one length as columns of one recording. The length is the one with the most columns whose
/// names are those of a gyroscope or accelerometer (core/signal/infer_role.hpp); if several lengths tie, the one with
/// the most numbers. A matrix of at most 16 rows with more columns than rows is transposed: its samples lie along the
/// rows. Three columns of one array are called `<name>_x`, `<name>_y`, `<name>_z`, any other number of columns
/// `<name>_0`, `<name>_1`, ...; a single column keeps the array's name. If no array is a time, a single number called
/// rate, rate_hz, fs, freq, frequency, samplerate, sampling_rate or sample_rate gives the sampling rate [Hz]; of
/// several the one that lies nearest, in the group or struct of the arrays before those above it. A note names the
/// arrays that are left out, and rates that contradict each other. Errors: NoSamples (no array of two samples),
/// LimitExceeded, those of the sink.
[[nodiscard]] Status deliver_variables(std::vector<Variable> variables, const DecodeLimits& limits, ColumnSink& sink);

}  // namespace driftlab
