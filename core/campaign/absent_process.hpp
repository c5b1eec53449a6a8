#pragma once
/// Processes of a fitted model whose estimated level is zero.
#include "core/campaign/reported_channel.hpp"

namespace driftlab {

/// Whether the best fit has none of the process: a parameter of it is missing for that reason, and its level was not
/// given. What is left of the fit is a model without it (core/campaign/table_cells.hpp says the same of a cell).
[[nodiscard]] bool none_found(const ReportedProcess& process);

}  // namespace driftlab
