#pragma once
/// The representation of a missing sample and of the reason why it is missing.
///
/// A column of numbers has no empty places, so a missing sample is a quiet NaN. Its payload (IEEE 754-2008, 6.2.1) says
/// what stood in the file instead, and in which row. Decoders write it where a cell holds no number. The user of the
/// column decides whether that is an error (view_recording refuses text in a sensor channel and names the line) or a
/// fact to report (an empty cell). The payload survives storage and copies but not arithmetic; it is read from decoded
/// columns only.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace driftlab {

/// What stood in the file where a number is missing.
enum class Missing : unsigned {
  Unknown,     ///< a NaN without payload, as arithmetic makes it
  Empty,       ///< nothing
  Nan,         ///< the word `nan`, or a NaN in binary
  Infinite,    ///< an infinity
  Text,        ///< something else that is no number
  OutOfRange,  ///< a number larger than a double can hold
  Ended,       ///< the column is shorter than the table: its sensor stopped earlier
};

struct MissingSample {
  Missing why = Missing::Unknown;
  std::uint64_t row = 0;  ///< in text the line of the file from 1, else the sample from 1; 0 where unknown
};

inline constexpr unsigned kMissingRowBits = 44;

/// The value that stands for a missing sample; rows beyond 2^44 are not kept.
[[nodiscard]] inline double missing_sample(Missing why, std::uint64_t row) {
  constexpr std::uint64_t kQuietNan = 0x7FF8000000000000U;
  constexpr std::uint64_t kRowMask = (std::uint64_t{1} << kMissingRowBits) - 1;
  return std::bit_cast<double>(kQuietNan | (static_cast<std::uint64_t>(why) << kMissingRowBits) | (row & kRowMask));
}

/// The reason and the row that the NaN `value` carries.
[[nodiscard]] inline MissingSample why_missing(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto why = static_cast<unsigned>((bits >> kMissingRowBits) & 7U);
  return {why <= static_cast<unsigned>(Missing::Ended) ? static_cast<Missing>(why) : Missing::Unknown,
          bits & ((std::uint64_t{1} << kMissingRowBits) - 1)};
}

}  // namespace driftlab
