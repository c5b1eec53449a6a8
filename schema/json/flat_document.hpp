#pragma once
/// Any document as a table of its values, for programs that read tables: R's read.csv, MATLAB's readtable, a
/// spreadsheet.
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// CSV (RFC 4180) with the columns path, index, number and text: a row for each value. `path` is the members and
/// positions that lead there, joined by dots; values of a list share the path of the list and are told apart by
/// `index`, from 1, which is empty elsewhere. A number stands in `number` as the shortest text that reads back as the
/// same double, a boolean or a string in `text`; for null and for an empty string both are empty.
[[nodiscard]] std::string flat_csv(const Json& document);

}  // namespace driftlab
