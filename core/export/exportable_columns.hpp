#pragma once
/// Which columns of a recording can be exported at all, asked before anything is computed of them.
#include "core/signal/quantity.hpp"
#include "core/signal/result.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// A column as it was named and understood.
struct ExportColumn {
  std::string name;
  Quantity quantity = Quantity::Unspecified;
  std::string axis;                      ///< may be empty
  Dimension dimension = Dimension::One;  ///< of its unit

  /// An axis of a gyroscope in a unit of angular rate, or one of an accelerometer in a unit of specific force.
  [[nodiscard]] bool exportable() const;
};

/// Success where a column can be exported. Error: NotFound, one sentence that names the columns which lack a unit, or
/// says that none is known to be an axis, with the repair.
[[nodiscard]] Status check_exportable(const std::vector<ExportColumn>& columns);

/// The columns that are an axis of `quantity` without a unit of it, in a sentence with the repair; empty: there are
/// none.
[[nodiscard]] std::string missing_units(const std::vector<ExportColumn>& columns, Quantity quantity);

}  // namespace driftlab
