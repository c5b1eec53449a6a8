#pragma once
/// The arrays of an HDF5 file.
#include "core/read/variable_stream.hpp"

#include <cstddef>
#include <span>

namespace driftlab::decode {

/// Writes every real array of one or two dimensions of the file whose bytes are `image`, and each numeric member of
/// its tables (one-dimensional arrays of compounds), under the path of its place with points between the names. In
/// files that MATLAB wrote dimensions stand the other way round. Links to other files, arrays kept outside the file,
/// references and texts are left out with a note. `budget_bytes` is what all arrays may take as doubles. Errors:
/// ShapeMismatch (damaged), LimitExceeded.
[[nodiscard]] Status write_hdf5_variables(std::span<const std::byte> image, std::size_t budget_bytes,
                                          VariableWriter& writer);

}  // namespace driftlab::decode
