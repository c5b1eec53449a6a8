#pragma once
/// Writes columns of numbers as CSV or NumPy file, by the ending of the name.
#include "core/analysis/simulate.hpp"
#include "core/signal/result.hpp"

#include <string>

namespace driftlab::cli {

/// `.npy`: version 1.0, little-endian doubles, C order, no names; else CSV with `comment` behind `# `, names and units.
/// Error: Io.
[[nodiscard]] Status write_table(const std::string& path, const std::string& comment, const SampleTable& table);

}  // namespace driftlab::cli
