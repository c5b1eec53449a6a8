#pragma once
/// Profiles without a name in a report (unnamed/unnamed_search.hpp): which of them the extended model holds, and the
/// checks of those that show something where every other check passes.
#include "core/investigate/report/report.hpp"

#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Keeps the profiles of channels in which something stays unexplained, and those that show something by themselves: by
/// their chance over all `channels`, which is below kShown, and by their size. Each of the latter is a failed check.
void report_unnamed(std::vector<UnnamedFinding> unnamed, std::size_t channels, Report& report);

}  // namespace driftlab::investigate
