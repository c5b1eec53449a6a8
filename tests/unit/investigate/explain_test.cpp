#include "core/investigate/report/explain.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/order.hpp"
#include "core/investigate/report/page.hpp"
#include "core/investigate/report/verdict.hpp"

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
      const std::size_t text = line.find_first_not_of(' ');  // a list within a list is indented
      EXPECT_TRUE(text == std::string::npos || line.find("  ", text) == std::string::npos) << line;
      EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
      findings += line.find("dentified. The recordings") != std::string::npos ||
                          line.find("mbiguous. The recordings") != std::string::npos
                      ? 1
                      : 0;
    }
    EXPECT_EQ(findings, report.findings.size());
  }
}

Finding of(const char* cause, double score, ChannelName channel) {
  Finding finding;
  finding.evidence.cause = find_cause(cause);
  finding.evidence.score = score;
  finding.channels.push_back(std::move(channel));
  return finding;
}

/// A report began with a line of noise that was strong, and said on its third page that samples were missing.
TEST(Order, ALaboratoryReadsFirstWhatItWouldActOnFirst) {
  std::vector<Finding> findings{
      of("output_resolution", 900.0, {"a", "gx [deg/s]"}),  of("random_walk", 500.0, {"a", "gz [deg/s]"}),
      of("scale_factor_error", 20.0, {"a", "gx [deg/s]"}),  of("temperature_bias", 30.0, {"a", "gy [deg/s]"}),
      of("scale_factor_error", 300.0, {"a", "gz [deg/s]"}), of("reference_time_offset", 15.0, {"a", "gz [deg/s]"}),
      of("missing_samples", 40.0, {"a", "gz [deg/s]"})};
  findings.push_back(of("g_sensitivity", 700.0, {"a", "gx [deg/s]"}));
  findings.back().evidence.ambiguous = true;
  put_in_order(findings);
  std::vector<std::string> said;
  for (const FindingGroup& group : groups_of(findings)) {
    said.emplace_back(group.cause->name);
  }
  EXPECT_EQ(said, (std::vector<std::string>{"missing_samples", "reference_time_offset", "scale_factor_error",
                                            "temperature_bias", "random_walk", "g_sensitivity", "output_resolution"}));
  EXPECT_EQ(findings[2].channels.front().text(), "a/gz [deg/s]") << "the stronger of two findings of one cause first";
  // A column's name may hold a slash: of "gz [deg/s]" the page once said "s]".
  EXPECT_EQ(groups_of(findings)[2].columns, (std::vector<std::string>{"gz [deg/s]", "gx [deg/s]"}));
}

TEST(Verdict, OneSentenceSaysWhatIsWrongAndWhatStillFails) {
  Report report;
  report.models.resize(1);
  report.checks.resize(3);
  EXPECT_EQ(verdict_of(report).sentence, "The recordings look like the simulation: none of 3 checks fails.");
  EXPECT_EQ(verdict_of(report).level, VerdictLevel::Fine);
  report.findings = {of("output_resolution", 900.0, {"a", "gx [deg/s]"})};
  EXPECT_EQ(verdict_of(report).level, VerdictLevel::Look) << "digits are no error";
  report.findings.insert(report.findings.begin(), of("scale_factor_error", 300.0, {"a", "gx [deg/s]"}));
  report.findings.front().channels.push_back({"b", "gx [deg/s]"});
  report.failed_before = 2;
  report.failed_after = 1;
  report.unexplained.push_back({"gx", "Something else is left.", {"b/gx.kurtosis"}});
  report.unexplained.push_back({"gx", "Something is left.", {"a/gx.kurtosis"}});
  const Verdict verdict = verdict_of(report);
  EXPECT_EQ(verdict.level, VerdictLevel::Wrong);
  EXPECT_EQ(verdict.sentence, "The simulation lacks " + std::string(find_cause("scale_factor_error")->title) +
                                  " (gx [deg/s]); 1 check still fails (gx).");
  EXPECT_EQ(verdict.details.back(), "Something is left.");
}

TEST(Alternatives, AreTheRivalsAndLastAnUnnamedEffectWhereOneIsDoubted) {
  const std::vector<Cause>& causes = cause_registry();
  Evidence evidence;
  EXPECT_TRUE(alternatives_of(evidence).empty());
  for (std::size_t k = 0; k < kMostAlternatives; ++k) {
    evidence.rivals.emplace_back().cause = &causes[k];
  }
  const std::vector<std::string> names = alternatives_of(evidence);
  ASSERT_EQ(names.size(), kMostAlternatives);
  EXPECT_EQ(names.front(), causes.front().name);
  // With a doubt the list is no longer than without: the schema of an investigation allows five.
  evidence.doubt = "The noise changes with the motion.";
  std::vector<std::string> doubted = names;
  doubted.back() = "unnamed";
  EXPECT_EQ(alternatives_of(evidence), doubted);
  evidence.rivals.clear();
  EXPECT_EQ(alternatives_of(evidence), std::vector<std::string>{"unnamed"});
}

}  // namespace
}  // namespace driftlab::investigate
