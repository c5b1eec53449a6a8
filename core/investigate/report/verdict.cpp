#include "core/investigate/report/verdict.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/explain.hpp"
#include "core/investigate/report/order.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kNamed = 4;  ///< causes in the sentence

/// "a bias that follows the temperature (gx, gy)".
std::string phrase(const FindingGroup& group) {
  return std::string(group.cause->title) + " (" + list_of(group.columns) + ")" +
         (group.ambiguous ? " or what looks like it" : "");
}

/// What the sentence names: all but the format, unless there is nothing else.
std::string named(const std::vector<FindingGroup>& groups) {
  std::vector<std::string> phrases;
  for (const FindingGroup& group : groups) {
    if (concern_of(*group.cause) != Concern::Format) {
      phrases.push_back(phrase(group));
    }
  }
  for (const FindingGroup& group : groups) {
    if (phrases.empty()) {
      phrases.push_back(phrase(group));
    }
  }
  if (phrases.size() > kNamed) {
    const std::size_t more = phrases.size() - kNamed;
    phrases.resize(kNamed);
    phrases.push_back(std::to_string(more) + " more");
  }
  return list_of(phrases);
}

std::string what_remains(const Report& report) {
  if (report.failed_after == 0) {
    return "no check fails with the extended model";
  }
  std::vector<std::string> columns;
  for (const Unexplained& left : report.unexplained) {
    if (std::find(columns.begin(), columns.end(), left.channel) == columns.end()) {
      columns.push_back(left.channel);
    }
  }
  return with_count(report.failed_after, "check still fails", "checks still fail") + " (" + list_of(columns) + ")";
}

VerdictLevel level_of(const Report& report) {
  const bool wrong = std::any_of(report.findings.begin(), report.findings.end(), [](const Finding& finding) {
    return !finding.evidence.ambiguous && concern_of(*finding.evidence.cause) != Concern::Format;
  });
  const bool look = !report.findings.empty() || report.failed_before > 0 || report.failed_after > 0;
  return wrong ? VerdictLevel::Wrong : look ? VerdictLevel::Look : VerdictLevel::Fine;
}

}  // namespace

Verdict verdict_of(const Report& report) {
  Verdict verdict;
  verdict.level = level_of(report);
  const std::string all = with_count(report.checks.size(), "check", "checks");
  if (report.models.empty()) {
    verdict.sentence = "No channel of this study can be examined.";
    verdict.level = VerdictLevel::Look;
  } else if (report.findings.empty() && report.failed_before == 0) {
    verdict.sentence = "The recordings look like the simulation: none of " + all + " fails.";
  } else if (report.findings.empty()) {
    verdict.sentence =
        "The recordings do not look like the simulation, and no cause of the list says why: " + what_remains(report) +
        ", of " + all + ".";
  } else {
    const bool format_alone = std::all_of(report.findings.begin(), report.findings.end(), [](const Finding& finding) {
      return concern_of(*finding.evidence.cause) == Concern::Format;
    });
    verdict.sentence =
        (format_alone ? "The simulation fits but for the format of the file: " : "The simulation lacks ") +
        named(groups_of(report.findings)) + "; " + what_remains(report) + ".";
  }
  const bool gains = std::any_of(report.findings.begin(), report.findings.end(),
                                 [](const Finding& finding) { return finding.gain.explained > 0.0; });
  if (gains) {
    verdict.details.push_back("The findings explain " + percent(report.explained) +
                              " of what the baseline gets wrong, on samples they were not fitted to.");
    verdict.facts.emplace_back("/gain/explained", report.explained);
  }
  for (const ChannelFigures& figures : report.figures) {
    const std::string change = report.findings.empty() ? "" : allan_in_words(figures);
    if (!change.empty()) {
      verdict.details.push_back(change);
    }
  }
  if (report.outages && !report.findings.empty()) {
    const auto metres = [](const Estimate& e) { return significant(e.value, e.ci95.low, e.ci95.high) + " m"; };
    verdict.details.push_back("Position error after an outage of 10 s: " + metres(report.outages->baseline_m) +
                              " as the baseline predicts it, " + metres(report.outages->extended_m) +
                              " as the extended model does.");
    verdict.facts.emplace_back("/gain/outage_error_m/extended", report.outages->extended_m.value);
  }
  for (const Unexplained& left : report.unexplained) {
    verdict.details.push_back(left.sentence);
  }
  std::string told;  // the channel whose first profile, the largest gain, has been told
  for (const UnnamedFinding& found : report.unnamed) {
    if (std::exchange(told, found.effect.column) == found.effect.column) {
      continue;
    }
    const bool said = std::any_of(report.unexplained.begin(), report.unexplained.end(),
                                  [&](const Unexplained& left) { return left.sentence.starts_with(found.sentence); });
    verdict.details.push_back(said ? "The extended model holds this of " + found.effect.column + " without a name."
                                   : found.sentence + ". The extended model holds this without a name.");
  }
  verdict.facts.emplace_back("/gain/checks_failed_before", static_cast<double>(report.failed_before));
  verdict.facts.emplace_back("/gain/checks_failed_after", static_cast<double>(report.failed_after));
  return verdict;
}

}  // namespace driftlab::investigate
