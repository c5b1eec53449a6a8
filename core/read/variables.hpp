#pragma once
/// A recording from named arrays: what .npz and MATLAB files hold. Internal to core/read.
#include "core/read/memory_table.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// A matrix, column by column.
struct Variable {
  std::string name;
  std::vector<std::vector<double>> columns;
};

/// Puts the arrays together that have one length: that of the most columns named as sensors are
/// (core/signal/infer_role.hpp), of equals that of the most numbers. A matrix of at most 16 rows and more columns than
/// rows holds its samples across. Three columns of one array are called `<name>_x`, `_y`,
/// `_z`, others
/// `<name>_0`, ...; a single column keeps the array's name. A single number called rate, fs, freq, sampling_rate,
/// sample_rate gives the time where no array does. What is left out is noted. Errors: NoSamples (no array of two
/// samples), LimitExceeded, those of the sink.
[[nodiscard]] Status deliver_variables(std::vector<Variable> variables, const DecodeLimits& limits, ColumnSink& sink);

}  // namespace driftlab
