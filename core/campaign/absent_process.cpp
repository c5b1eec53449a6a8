#include "core/campaign/absent_process.hpp"

#include "core/campaign/table_cells.hpp"

#include <algorithm>

namespace driftlab {

bool none_found(const ReportedProcess& process) {
  return std::any_of(process.parameters.begin(), process.parameters.end(), [](const auto& parameter) {
    const ReportedValue& told = parameter.second;
    return !told.value && !told.reason.empty() && absence_of(told.reason) == Absence::NoneFound;
  });
}

}  // namespace driftlab
