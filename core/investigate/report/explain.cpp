#include "core/investigate/report/explain.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

namespace driftlab::investigate {
namespace {

std::string short_text(double value, int digits = 4) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
  return error == std::errc{} ? std::string(buffer, end) : std::string("?");
}

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) {
      text.append(i + 1 == items.size() ? " and " : ", ");
    }
    text.append(items[i]);
  }
  return text;
}

}  // namespace

std::string in_words(const FoundParameter& parameter) {
  const double k = parameter.unit.per_si;
  std::string text = short_text(parameter.estimate.value * k);
  if (parameter.unit.symbol != "1") {
    text.append(" ").append(parameter.unit.symbol);
  }
  text.append(" (").append(short_text(parameter.estimate.ci95.low * k)).append(" to ");
  text.append(short_text(parameter.estimate.ci95.high * k)).append(")");
  return text;
}

std::string explain(const Finding& finding, const ChannelGroup& group) {
  const Evidence& evidence = finding.evidence;
  std::string text = "The recordings of ";
  text.append(group.column).append(" show ").append(evidence.cause->title).append(": ");
  std::vector<std::string> parts;
  for (const FoundParameter& parameter : evidence.parameters) {
    parts.push_back(parameter.name + " = " + in_words(parameter));
  }
  text.append(list_of(parts)).append(", in ");
  text.append(evidence.members.size() == group.members.size()
                  ? std::string("all recordings")
                  : list_of(finding.channels.size() <= 6
                                ? finding.channels
                                : std::vector<std::string>{finding.channels.front(), "others"}));
  text.append(".");
  if (evidence.cause->as<FileFact>() != nullptr) {
    text.append(" The file itself shows it.").append(evidence.note.empty() ? "" : " ").append(evidence.note);
  } else {
    text.append(" Adding it to the model raises twice the log likelihood by ");
    text.append(short_text(evidence.gain, 3)).append(".");
  }
  if (evidence.ambiguous) {
    std::vector<std::string> names;
    for (const Evidence& rival : evidence.rivals) {
      names.emplace_back(rival.cause->title);
    }
    text.append(" These data cannot tell it from ").append(list_of(names)).append(".");
  }
  return text;
}

std::string next_measurement(const Finding& finding) {
  return finding.evidence.ambiguous ? std::string(finding.evidence.cause->separates) : std::string();
}

namespace {

void append_outages(const OutageGain& outages, bool anything_found, std::string& page) {
  const auto metres = [](const Estimate& error) {
    return short_text(error.value, 3) + " m [" + short_text(error.ci95.low, 3) + ", " + short_text(error.ci95.high, 3) +
           "]";
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

}  // namespace

std::string markdown(const Report& report) {
  std::string page = "# Investigation of ";
  page.append(report.study).append("\n\n");
  page.append(report.automatic ? "The baseline was fitted to the recordings themselves.\n\n"
                               : "The baseline was given and is taken at its word.\n\n");
  page.append("## What the simulation gets wrong\n\n");
  if (report.findings.empty()) {
    page.append("Nothing was found: the recordings look like the simulation.\n\n");
  }
  int number = 1;
  for (const Finding& finding : report.findings) {
    page.append(std::to_string(number++)).append(". **").append(finding.evidence.cause->name).append("** (");
    page.append(finding.evidence.ambiguous ? "ambiguous" : "identified").append("). ");
    page.append(finding.explanation);
    if (finding.gain.heldout) {
      page.append(" On samples it was not fitted to the gain is ");
      page.append(short_text(finding.gain.log_score_per_sample, 3)).append(" nat per sample.");
    }
    if (!finding.next_measurement.empty()) {
      page.append(" To separate them, measure: ").append(finding.next_measurement).append(".");
    }
    page.append("\n");
  }
  if (report.outages) {
    append_outages(*report.outages, !report.findings.empty(), page);
  }
  page.append("\n## What remains\n\n");
  if (report.unexplained.empty()) {
    page.append("No check fails with the extended model.\n");
  }
  for (const Unexplained& left : report.unexplained) {
    page.append("- ").append(left.sentence).append(" Failing: ").append(list_of(left.checks)).append(".\n");
  }
  page.append(
      "\n## Checks\n\n| check | observed | simulated 2.5 % | median | 97.5 % | p adjusted "
      "|\n|---|---|---|---|---|---|\n");
  for (const Check& check : report.checks) {
    page.append("| ").append(check.id).append(check.failed ? " **fails**" : "").append(" | ");
    page.append(short_text(check.observed)).append(" | ").append(short_text(check.q025)).append(" | ");
    page.append(short_text(check.median)).append(" | ").append(short_text(check.q975)).append(" | ");
    page.append(short_text(check.p_adjusted, 2)).append(" |\n");
  }
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
