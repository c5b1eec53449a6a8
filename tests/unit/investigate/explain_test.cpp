#include "core/investigate/report/explain.hpp"

#include "core/investigate/causes/cause.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

/// One finding of a cause that the file itself shows, or of one that a likelihood speaks for, with its explanation.
Finding explained(bool fact, const std::string& note, bool ambiguous) {
  Finding finding;
  finding.evidence.cause = &*std::find_if(cause_registry().begin(), cause_registry().end(), [&](const Cause& cause) {
    return (cause.as<FileFact>() != nullptr) == fact;
  });
  finding.evidence.parameters = {{"r", {0.1, {0.05, 0.15}}, {"s", 1.0}}};
  finding.evidence.members = {0};
  finding.evidence.gain = 42.0;
  finding.evidence.note = note;
  finding.evidence.ambiguous = ambiguous;
  if (ambiguous) {
    finding.evidence.rivals = {finding.evidence};
    finding.next_measurement = next_measurement(finding);
  }
  finding.gain.heldout = true;
  ChannelGroup group;
  group.column = "gz";
  group.members.resize(1);
  finding.explanation = explain(finding, group);
  return finding;
}

/// The page of a report had two blanks before "On samples" wherever a finding had no rival, and an explanation ended
/// with a blank: each sentence brought a blank of its own for a next one that might not come.
TEST(Explain, NoSentenceOfAPageHasTwoBlanksInARow) {
  Report report;
  report.study = "s";
  for (const bool fact : {false, true}) {
    for (const char* const note : {"", "The longest run begins 1.0 s after the first sample and lasts 2.0 s."}) {
      for (const bool ambiguous : {false, true}) {
        report.findings.push_back(explained(fact, note, ambiguous));
        const std::string& text = report.findings.back().explanation;
        EXPECT_EQ(text.back(), '.') << text;
        EXPECT_EQ(text.find("  "), std::string::npos) << text;
        EXPECT_EQ(text.find(note) != std::string::npos, fact || *note == '\0') << text;
      }
    }
  }
  const std::string without_notes = markdown(report);
  report.notes = {"A note.", "Another one."};
  for (const std::string& page : {without_notes, markdown(report)}) {
    std::istringstream lines(page);
    std::size_t findings = 0;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_EQ(line.find("  "), std::string::npos) << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
      findings += line.find(". On samples it was not fitted to") != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(findings, report.findings.size());
  }
}

}  // namespace
}  // namespace driftlab::investigate
