#pragma once
/// A count with its noun, for notes and sentences: "1 gap", "2 gaps". Nothing that driftlab says reads "1 gaps".
#include <concepts>
#include <string>
#include <string_view>

namespace driftlab {

/// `count` and the words that agree with it: `one` for exactly 1, else `several`, which also carries a verb where the
/// sentence has one ("sample is missing", "samples are missing").
[[nodiscard]] std::string with_count(std::integral auto count, std::string_view one, std::string_view several) {
  return std::to_string(count).append(" ").append(count == 1 ? one : several);
}

/// The same for a noun whose plural is an s: "0 rows", "1 row", "2 rows".
[[nodiscard]] std::string with_count(std::integral auto count, std::string_view noun) {
  return with_count(count, noun, std::string(noun) + "s");
}

/// "once", "2 times".
[[nodiscard]] std::string how_often(std::integral auto count) {
  return count == 1 ? std::string("once") : std::to_string(count) + " times";
}

}  // namespace driftlab
