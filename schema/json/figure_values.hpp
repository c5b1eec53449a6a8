#pragma once
/// Numbers and words of documents as figures take them.
#include "core/analysis/drawn_values.hpp"
#include "schema/figure/printed_names.hpp"
#include "schema/json/json.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// The number, or nothing where the document has none.
[[nodiscard]] std::optional<double> value_of(const Json& value);
[[nodiscard]] Values values_of(const Json& list);
/// One end (0 or 1) of each interval.
[[nodiscard]] Values ends_of(const Json& intervals, std::size_t end);
/// Numbers that are all there; 0 for one that is not.
[[nodiscard]] std::vector<double> numbers_of(const Json& list);

/// {"value", "unit", "ci95"} with the digits that the interval allows.
[[nodiscard]] std::string quantity_text(const Json& quantity);
/// A name for a file and an id.
[[nodiscard]] std::string word(const std::string& text);

}  // namespace driftlab
