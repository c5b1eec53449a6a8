#pragma once
/// Writes columns of numbers as CSV or NumPy file, by the ending of the name.
#include "core/analysis/simulate.hpp"
#include "core/signal/result.hpp"

#include <string>
#include <string_view>

namespace driftlab::cli {

/// Does the name ask for a NumPy file, packed or not?
[[nodiscard]] bool is_array_name(std::string_view path);

/// `.npy`: version 1.0, little-endian doubles, C order, no names; else CSV with `comment` behind `# `, names and units.
/// Either is packed by gzip where the name goes on with `.gz`. Errors: InvalidArgument (the ending of another packing),
/// Io.
[[nodiscard]] Status write_table(const std::string& path, const std::string& comment, const SampleTable& table);

}  // namespace driftlab::cli
