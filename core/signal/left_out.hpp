#pragma once
/// A list without some of its places.
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// `values` without those at `left_out` (from 0, ascending, each once). O(values).
template <class Value>
[[nodiscard]] std::vector<Value> without(std::span<const Value> values, std::span<const std::size_t> left_out) {
  std::vector<Value> rest;
  rest.reserve(values.size() - left_out.size());
  auto next = left_out.begin();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (next != left_out.end() && *next == i) {
      ++next;
    } else {
      rest.push_back(values[i]);
    }
  }
  return rest;
}

}  // namespace driftlab
