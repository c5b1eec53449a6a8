#pragma once
/// A regression run for people and for the machines that gate merges: text, a page, a test report, a figure, a badge
/// (spec/regression.md, section 9). All say the sentences of core/campaign/regression/report.hpp.
#include "core/analysis/regress.hpp"

#include <string>

namespace driftlab {

/// The terminal: verdict, details, the worst five tests.
[[nodiscard]] std::string regression_to_text(const RegressReport& run);

/// A comment on a change, in Markdown: under 60 lines whatever was compared, first line the verdict, then a hidden
/// marker by which a bot finds its comment again. The worst five tests stand above, the next worst are folded, and what
/// is left out is said to be in the document. `figure` is the path or address of the figure; empty: none is shown.
[[nodiscard]] std::string regression_to_markdown(const RegressReport& run, const std::string& figure);

/// JUnit XML: a suite per device, condition and pair of labels, with a case per gated test; what is of all conditions
/// (event checks, every item that must agree, and the verdict) is in the one suite there is, or in one of its own. Open
/// gated tests are errors of type `inconclusive`, or skipped with `skip_open`; watched tests stand in system-out.
[[nodiscard]] std::string regression_to_junit(const RegressReport& run, bool skip_open);

/// The page and the test report of a run that ended without a verdict, for what the sentence says: as those of a run,
/// the first line and the marker, and the case `verdict` with an error.
[[nodiscard]] std::string no_verdict_to_markdown(const std::string& sentence);
[[nodiscard]] std::string no_verdict_to_junit(const std::string& sentence);

/// SVG, 20 px high: `sensor noise | no worse, 10 % to 20 s`.
[[nodiscard]] std::string regression_to_badge(const RegressReport& run);

/// SVG of the ratio candidate/baseline over tau, one panel per unit: simultaneous band, margin, scope shaded.
[[nodiscard]] std::string regression_to_svg(const RegressReport& run);

}  // namespace driftlab
