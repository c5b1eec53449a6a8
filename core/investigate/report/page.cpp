#include "core/investigate/report/page.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/explain.hpp"
#include "core/investigate/report/order.hpp"
#include "core/signal/significant.hpp"

#include <cmath>
#include <map>
#include <utility>

namespace driftlab::investigate {
namespace {

void append_findings(const Report& report, std::string& page) {
  page.append("## What the simulation gets wrong\n\n");
  if (report.findings.empty()) {
    page.append("No cause of the list was found.\n");
  }
  int number = 1;
  for (const FindingGroup& group : groups_of(report.findings)) {
    const bool several = group.findings.size() > 1;
    page.append(std::to_string(number++)).append(". **").append(group.cause->name).append("** (");
    page.append(name_of(concern_of(*group.cause))).append(several ? ", " + list_of(group.columns) : "").append("): ");
    page.append(group.cause->equation).append(".");
    for (const std::size_t i : group.findings) {
      const Finding& finding = report.findings[i];
      page.append(several ? "\n   - " : " ").append(finding.evidence.ambiguous ? "Ambiguous. " : "Identified. ");
      page.append(finding.explanation);
      if (!finding.next_measurement.empty()) {
        page.append(" To separate them, measure: ").append(finding.next_measurement).append(".");
      }
    }
    page.append("\n");
  }
}

void append_outages(const OutageGain& outages, bool anything_found, std::string& page) {
  const auto metres = [](const Estimate& error) {
    const double low = error.ci95.low;
    const double high = error.ci95.high;
    return significant(error.value, low, high) + " m [" + significant(low, low, high) + ", " +
           significant(high, low, high) + "]";
  };
  page.append(
      "\n## What it means in navigation\n\nMean horizontal position error at the end of two simulated outages of 10 "
      "s: ");
  page.append(metres(outages.baseline_m)).append(" as the baseline predicts it");
  if (anything_found) {
    page.append("; ")
        .append(metres(outages.extended_m))
        .append(" as the extended model does, for a filter that believes the baseline; ");
    page.append(metres(outages.adopted_m)).append(" for one that believes the extended model");
  }
  page.append(".");
  if (!outages.left_out.empty()) {
    page.append(" Not in this simulation: ").append(list_of(outages.left_out)).append(".");
  }
  if (!outages.left_out_of_filters.empty()) {
    page.append(" In the data and in no filter: ").append(list_of(outages.left_out_of_filters)).append(".");
  }
  page.append("\n");
}

void append_remains(const Report& report, std::string& page) {
  page.append("\n## What remains\n\n");
  if (report.failed_after == 0) {
    page.append("No check fails with the extended model.\n");
  }
  for (const Unexplained& left : report.unexplained) {
    page.append("- ").append(left.sentence);
    if (!left.checks.empty()) {
      page.append(" Failing: ").append(list_of(left.checks)).append(".");
    }
    page.append("\n");
  }
  if (!report.unnamed.empty()) {
    page.append("\nThe extended model holds, without a name:\n\n");
  }
  for (const UnnamedFinding& found : report.unnamed) {
    page.append("- ").append(found.sentence).append(". On data that it was not fitted to this profile gains ");
    page.append(significant(found.heldout_gain)).append(" nat.\n");
  }
  std::vector<std::string> mended;
  for (const Check& check : report.checks) {
    if (check.end == CheckEnd::Mended) {
      mended.push_back(check.id);
    }
  }
  if (!mended.empty()) {
    page.append("\nMended by the extended model, though no finding names them: ").append(list_of(mended)).append(".\n");
  }
}

/// The evidence of each finding, for those who want it in nats.
void append_evidence(const Report& report, std::string& page) {
  if (report.findings.empty()) {
    return;
  }
  page.append("\n## Evidence\n\n| finding | channels | score | held-out gain, nat per sample |\n|---|---|---|---|\n");
  for (const Finding& finding : report.findings) {
    page.append("| ")
        .append(finding.evidence.cause->name)
        .append(" | ")
        .append(finding.channels.empty() ? "-" : list_of(texts_of(finding.channels)));
    page.append(" | ").append(significant(finding.evidence.score)).append(" | ");
    page.append(finding.gain.heldout ? significant(finding.gain.log_score_per_sample) : "-");
    page.append(finding.gain.heldout && finding.gain.of_the_file ? " (of the file's digits and rows)" : "");
    page.append(" |\n");
  }
  page.append(
      "\nThe score is twice the log likelihood that the finding gains over the best model without it, less what its "
      "freedom costs; a finding needs 10.\n");
}

void append_checks(const Report& report, std::string& page) {
  page.append(
      "\n## Checks\n\n| check | observed | simulated 2.5 % | median | 97.5 % | p adjusted | p with the extended model "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const Check& check : report.checks) {
    // The kurtosis that the file's last digit makes, of 1e-19 or so, is 0 beside the check's interval.
    const double median = std::fabs(check.median) < 1e-12 * (check.q975 - check.q025) ? 0.0 : check.median;
    page.append("| ").append(check.id).append(check.failed ? " **fails**" : "").append(" | ");
    page.append(significant(check.observed)).append(" | ").append(significant(check.q025)).append(" | ");
    page.append(significant(median)).append(" | ").append(significant(check.q975)).append(" | ");
    page.append(significant(check.p_adjusted)).append(" | ").append(significant(check.p_after_adjusted));
    page.append(check.failed_after ? " **fails**" : "").append(" |\n");
  }
}

}  // namespace

std::string markdown(const Report& report) {
  std::string page = "# Investigation of ";
  page.append(report.study).append("\n\n").append(report.summary.sentence).append("\n\n");
  for (const std::string& detail : report.summary.details) {
    page.append("- ").append(detail).append("\n");
  }
  page.append(report.summary.details.empty() ? "" : "\n");
  page.append(report.automatic ? "The baseline was fitted to the recordings themselves.\n\n"
                               : "The baseline was given and is taken at its word.\n\n");
  append_findings(report, page);
  if (report.outages) {
    append_outages(*report.outages, !report.findings.empty(), page);
  }
  append_remains(report, page);
  append_evidence(report, page);
  append_checks(report, page);
  if (!report.not_examined.empty()) {
    page.append("\n## What could not be examined\n\n");
    std::map<std::pair<std::string, std::string>, std::string> causes;  // of each need and channel
    for (const NotExamined& item : report.not_examined) {
      std::string& list = causes[{item.needs, item.channel}];
      list.append(list.empty() ? "" : ", ").append(item.cause);
    }
    for (const auto& [what, list] : causes) {
      page.append("- On ").append(what.second).append(", for want of ").append(what.first).append(": ");
      page.append(list).append(".\n");
    }
  }
  for (const std::string& note : report.notes) {
    page.append("\nNote: ").append(note).append("\n");
  }
  return page;
}

}  // namespace driftlab::investigate
