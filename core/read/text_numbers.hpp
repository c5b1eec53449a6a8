#pragma once
/// Numbers of a text whose columns are known. Internal to core/read.
#include "core/read/decimal.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/result.hpp"
#include "core/signal/with_count.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::text {

/// The number that `cell` is; NaN for `nan` and `inf`; nothing for any other text.
[[nodiscard]] inline std::optional<double> number_of(std::string_view cell) {
  const std::string copy(trim(cell));
  double value = 0.0;
  if (!copy.empty() && decimal::parse(copy.c_str(), value) == copy.c_str() + copy.size() && std::isfinite(value)) {
    return value;
  }
  return is_non_finite_word(copy) ? std::optional(std::numeric_limits<double>::quiet_NaN()) : std::nullopt;
}

/// A whole number of nanoseconds.
[[nodiscard]] inline std::optional<std::uint64_t> stamp_of(std::string_view cell) {
  cell = trim(cell);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() ? std::optional(value) : std::nullopt;
}

[[nodiscard]] inline tl::unexpected<Error> not_a_number(std::uint64_t line, std::string_view cell) {
  const std::string row = std::to_string(line);
  return fail(ErrorCode::NotANumber, "Line " + row + ": " + excerpt(cell) + " is not a number.", {{"row", row}});
}

[[nodiscard]] inline tl::unexpected<Error> wrong_cells(std::uint64_t line, std::size_t found, std::size_t wanted) {
  const std::string row = std::to_string(line);
  return fail(ErrorCode::RaggedRow,
              "Line " + row + " has " + with_count(found, "cell") + " instead of " + std::to_string(wanted) + ".",
              {{"row", row}});
}

}  // namespace driftlab::text
