#pragma once
/// The order of findings, and those that say the same of several channels.
///
/// A laboratory acts on an error of the recording before it calibrates, and calibrates before it models noise; the
/// number format of the file is information, not a task. Identified findings come before ambiguous ones. Findings are
/// therefore sorted by certainty and then by concern (causes/cause.hpp), with the format last; within these the cause
/// with the strongest finding comes first, and all findings of one cause stand together.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/report.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// Findings of one cause, which stand next to each other.
struct FindingGroup {
  const Cause* cause = nullptr;
  std::vector<std::size_t> findings;  ///< places in the report's list
  std::vector<std::string> columns;   ///< each once
  bool ambiguous = false;             ///< all of them are
};

void put_in_order(std::vector<Finding>& findings);

/// Of findings in order.
[[nodiscard]] std::vector<FindingGroup> groups_of(const std::vector<Finding>& findings);

[[nodiscard]] std::string_view name_of(Concern concern);

}  // namespace driftlab::investigate
