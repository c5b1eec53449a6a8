#pragma once
/// A regression run for people and for the machines that gate merges: text, a page, a test report, a figure, a badge
/// (spec/regression.md, section 9). All say the sentences of core/campaign/regression/report.hpp.
#include "core/analysis/regress.hpp"

#include <string>

namespace driftlab {

/// The terminal: verdict, details, the worst five tests.
[[nodiscard]] std::string regression_to_text(const RegressReport& run);

/// A comment on a change, in Markdown: under 60 lines outside of what is folded, first line the verdict, then a hidden
/// marker by which a bot finds its comment again. `figure` is the path or address of the figure; empty: none is shown.
[[nodiscard]] std::string regression_to_markdown(const RegressReport& run, const std::string& figure);

/// JUnit XML: a case per gated test, event check and comparability item, and one for the verdict. Open gated tests are
/// errors of type `inconclusive`, or skipped with `skip_open`; watched tests stand in system-out.
[[nodiscard]] std::string regression_to_junit(const RegressReport& run, bool skip_open);

/// SVG, 20 px high: `sensor noise | no worse, 10 % to 20 s`.
[[nodiscard]] std::string regression_to_badge(const RegressReport& run);

/// SVG of the ratio candidate/baseline over tau, one panel per unit: simultaneous band, margin, scope shaded.
[[nodiscard]] std::string regression_to_svg(const RegressReport& run);

}  // namespace driftlab
