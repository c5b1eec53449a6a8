#pragma once
/// The report as a Markdown page for people: one verdict, the findings in the order of acting on them, what they
/// change, what remains, and the evidence behind it all.
#include "core/investigate/report/report.hpp"

#include <string>

namespace driftlab::investigate {

[[nodiscard]] std::string markdown(const Report& report);

}  // namespace driftlab::investigate
