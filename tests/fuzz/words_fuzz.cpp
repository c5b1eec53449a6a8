/// Any text as a condition, a unit, a quantity and a column name: what users write on the command line, in query
/// strings and in header rows.
#include "core/signal/condition.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/quantity.hpp"
#include "core/signal/unit.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace driftlab;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto condition = parse_condition(text)) {
    // The compact form keeps kind, axis, direction and unit; the value to its fifteen digits.
    const auto again = parse_condition(to_text(*condition));
    if (!again || to_text(*again) != to_text(*condition) || label(*condition).empty()) {
      std::abort();
    }
  }
  if (const auto unit = parse_unit(text); unit && parse_unit(unit->symbol)->symbol != unit->symbol) {
    std::abort();
  }
  if (const auto quantity = parse_quantity(text); quantity && name_of(*quantity) != text) {
    std::abort();
  }
  if (!check_role("column", infer_role(text)) && infer_role(text).unit == std::nullopt) {
    std::abort();  // only a stated unit can contradict what a name says
  }
  return 0;
}
