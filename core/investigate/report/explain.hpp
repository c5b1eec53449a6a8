#pragma once
/// Sentences for people: what was found, how sure it is, what to measure next.
#include "core/investigate/report/report.hpp"

#include <string>

namespace driftlab::investigate {

/// One paragraph a lab engineer understands.
[[nodiscard]] std::string explain(const Finding& finding, const ChannelGroup& group);

/// The measurement that would separate an ambiguous finding from its rivals; empty for an identified one.
[[nodiscard]] std::string next_measurement(const Finding& finding);

/// "0.0123 deg/s (0.0110 to 0.0136)".
[[nodiscard]] std::string in_words(const FoundParameter& parameter);

/// The report as a Markdown page.
[[nodiscard]] std::string markdown(const Report& report);

}  // namespace driftlab::investigate
