#pragma once
/// The header of a NumPy .npy file. Internal to core/read.
#include "core/read/byte_source.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace driftlab::formats {

enum class NpyKind { Float, Signed, Unsigned };

/// What the header declares, checked: rows * columns * item_bytes does not overflow, columns is within the limits.
/// Nothing may be allocated from `rows`.
struct NpyHeader {
  NpyKind kind = NpyKind::Float;
  std::size_t item_bytes = 8;  ///< of a float 4 or 8, of a whole number 1, 2, 4 or 8
  bool swap = false;           ///< the other byte order than this machine
  bool fortran_order = false;  ///< column by column; false where there is one column
  std::uint64_t rows = 0;
  std::size_t columns = 1;

  /// "1000 x 6".
  [[nodiscard]] std::string shape_text() const { return std::to_string(rows) + " x " + std::to_string(columns); }
};

/// Takes the header from `source`, which then stands at the first number. Errors: Truncated, ShapeMismatch,
/// UnsupportedType (naming the element type), NoSamples, LimitExceeded.
[[nodiscard]] Result<NpyHeader> read_npy_header(ByteSource& source, const DecodeLimits& limits);

}  // namespace driftlab::formats
