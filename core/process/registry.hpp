#pragma once
/// Every process driftlab knows, in the canonical order in which models name them.
/// To add one: a file like white_noise.hpp and a line in registry.cpp; the law suite (tests/property) then tests it.
#include "core/process/process.hpp"

#include <string_view>
#include <vector>

namespace driftlab {

[[nodiscard]] const std::vector<ProcessKind>& process_registry();

/// By registry name (`white_noise`) or symbol (`WN`); null where there is none.
[[nodiscard]] const ProcessKind* find_process(std::string_view name_or_symbol);

/// The registered kind of a value type: registered<GaussMarkov>().
template <class T>
[[nodiscard]] const ProcessKind& registered() {
  static const ProcessKind& kind = *find_process(T::kName);
  return kind;
}

/// Position in the registry, which is the canonical order.
[[nodiscard]] std::size_t registry_index(const ProcessKind* kind);

}  // namespace driftlab
