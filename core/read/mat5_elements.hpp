#pragma once
/// The data elements of a MATLAB level 5 file, read from memory. Internal to core/read.
///
/// Source: The MathWorks, "MAT-File Format", version R2020a, chapter 1: an element is a tag (type, bytes) and its data,
/// padded to 8 bytes; up to 4 bytes of data fit into the tag itself. A matrix is an element of elements.
#include "core/read/variables.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::mat5 {

/// Element types (table 1-1).
enum Type : std::uint32_t {
  Int8 = 1,
  UInt8 = 2,
  Int16 = 3,
  UInt16 = 4,
  Int32 = 5,
  UInt32 = 6,
  Single = 7,
  Double = 9,
  Int64 = 12,
  UInt64 = 13,
  Matrix = 14,
  Compressed = 15,
};

/// What a matrix element holds, as far as it is numbers: itself, or the fields of a struct as `struct.field`.
struct Contents {
  std::vector<Variable> variables;
  std::vector<std::string> left_out;  ///< `name (class)` of what is no array of real numbers
};

/// Reads the body of one matrix element. `swap`: the file has the other byte order. `budget_bytes` bounds the doubles
/// made. Errors: ShapeMismatch (the element contradicts itself), Truncated, LimitExceeded.
[[nodiscard]] Status read_matrix(std::string_view body, bool swap, std::size_t& budget_bytes, Contents& contents);

}  // namespace driftlab::mat5
