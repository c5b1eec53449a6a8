#pragma once
/// Sentences for people: what was found, how sure it is, what to measure next. Numbers have the digits that their
/// intervals let stand (core/signal/significant.hpp).
#include "core/investigate/report/report.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// "a, b and c".
[[nodiscard]] std::string list_of(const std::vector<std::string>& items);

/// "62 %"; "less than 1 %".
[[nodiscard]] std::string percent(double share);

/// One paragraph a lab engineer understands. `finding.gain` is settled.
[[nodiscard]] std::string explain(const Finding& finding, const ChannelGroup& group);

/// The measurement that would separate an ambiguous finding from its rivals; empty for an identified one.
[[nodiscard]] std::string next_measurement(const Finding& finding);

/// "0.0123 deg/s (0.0110 to 0.0136)".
[[nodiscard]] std::string in_words(const FoundParameter& parameter);

/// How the findings change the Allan deviation of a channel at about 1, 10, 100 and 1000 s; empty where the baseline
/// and the extended model agree within 5 % at all of them.
[[nodiscard]] std::string allan_in_words(const ChannelFigures& figures);

}  // namespace driftlab::investigate
