/// Terminal text and Markdown page of a regression run.
#include "core/signal/short_name.hpp"
#include "core/signal/with_count.hpp"
#include "schema/text/fields.hpp"
#include "schema/text/regression.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

namespace driftlab {
namespace {

using regression::ScaleReport;
using regression::ToldTest;

constexpr std::size_t kWorstTests = 5;
/// What keeps a page below 60 lines, whatever was compared: 42 lines are its own.
constexpr std::size_t kFoldedTests = 15;
constexpr std::size_t kMostDetails = 12;

std::string test_place(const ScaleReport& test) {
  return test.name.empty() ? regression::duration_text(test.test.tau_s) : test.name;
}

std::string test_figures(const ScaleReport& test) {
  return regression::interval_text(test.theta, test.outcome.lower, test.outcome.upper) + ", margin " +
         regression::percent_text(test.test.margin).substr(1);
}

std::string head_word(regression::Verdict verdict) {
  switch (verdict) {
    case regression::Verdict::Pass:
      return "PASS";
    case regression::Verdict::Fail:
      return "FAIL";
    case regression::Verdict::Inconclusive:
      break;
  }
  return "INCONCLUSIVE";
}

std::string arm_line(const char* name, const regression::ArmReport& arm) {
  std::string recordings;
  for (const regression::ArmReport::Session& session : arm.sessions) {
    for (const std::string& id : session.recordings) {
      recordings += (recordings.empty() ? "" : ", ") + id;
    }
  }
  return std::string(name) + (arm.label.empty() ? "" : " " + arm.label) + ": " + std::to_string(arm.sessions.size()) +
         (arm.sessions.size() == 1 ? " session" : " sessions") + " (" + recordings + ")";
}

std::string look_line(const Look& look) {
  return "Look " + std::to_string(look.number) + " of " + std::to_string(look.of) + " at this candidate label" +
         (look.counted ? "." : " (not counted).");
}

std::string worst_row(const ToldTest& told) {
  const ScaleReport& test = *told.test;
  return "| " + short_sensor_name(told.unit->name) + " | " + test_place(test) + " | " + test_figures(test) + " | " +
         std::string(name_of(test.outcome.finding)) + (test.gated ? "" : ", watched") + " |\n";
}

/// Where to find what a bounded list leaves out; empty where it holds everything.
std::string more_line(const char* bullet, std::size_t all, std::size_t shown, const char* noun, const char* member) {
  return all <= shown ? std::string()
                      : bullet + with_count(all - shown, noun) + " more: `" + member + "` of the document" +
                            " (regression.json).\n";
}

/// "rec_1 (cable touched); rec_2 (...)": every one, for leaving a recording out must be seen.
std::string exclusions_text(const std::vector<regression::Exclusion>& excluded) {
  std::string text;
  for (const regression::Exclusion& exclusion : excluded) {
    text += (text.empty() ? "" : "; ") + exclusion.recording + " (" + exclusion.reason + ")";
  }
  return text;
}

/// By which a bot finds its comment again.
const char* const kMarker = "<!-- driftlab-regression -->\n\n";
const char* const kWorstHead = "| axis | at | change | finding |\n|---|---|---|---|\n";

}  // namespace

std::string regression_to_text(const RegressReport& run) {
  const regression::Report& report = run.report;
  std::string text = head_word(report.verdict) + ": " + report.summary.verdict + "\n";
  for (const std::string& detail : report.summary.details) {
    text += "  " + detail + "\n";
  }
  text += arm_line("Baseline", report.baseline) + "\n" + arm_line("Candidate", report.candidate) + "\n";
  text += look_line(run.look) + "\n";
  for (const regression::Exclusion& exclusion : report.excluded) {
    text += "Left out: " + exclusion.recording + " (" + exclusion.reason + ")\n";
  }
  if (run.versus_previous) {
    text += "Against " + run.versus_previous->label + ": " + run.versus_previous->sentence + "\n";
  }
  const std::vector<ToldTest> tests = regression::by_distance(report);
  for (std::size_t i = 0; i < std::min(kWorstTests, tests.size()); ++i) {
    std::array<char, 160> line{};
    const int length = std::snprintf(
        line.data(), line.size(), "  %-10s %-22s %-36s %s%s\n", short_sensor_name(tests[i].unit->name).c_str(),
        test_place(*tests[i].test).c_str(), test_figures(*tests[i].test).c_str(),
        std::string(name_of(tests[i].test->outcome.finding)).c_str(), tests[i].test->gated ? "" : ", watched");
    text.append(line.data(), std::min(static_cast<std::size_t>(length), line.size() - 1));
  }
  return text;
}

std::string regression_to_markdown(const RegressReport& run, const std::string& figure) {
  const regression::Report& report = run.report;
  std::string page = "**" + head_word(report.verdict) + "**: " + markdown_field(report.summary.verdict) + "\n";
  page += kMarker;
  const std::vector<std::string>& details = report.summary.details;
  for (std::size_t i = 0; i < std::min(kMostDetails, details.size()); ++i) {
    page += "- " + markdown_field(details[i]) + "\n";
  }
  page += more_line("- ", details.size(), kMostDetails, "sentence", "summary.details");
  if (!report.excluded.empty()) {
    page += "- Left out: " + markdown_field(exclusions_text(report.excluded)) + "\n";
  }
  if (run.versus_previous) {
    page += "- Against " + markdown_field(run.versus_previous->label) +
            ", as information: " + markdown_field(run.versus_previous->sentence) + "\n";
  }
  const std::vector<ToldTest> tests = regression::by_distance(report);
  if (!tests.empty()) {
    page += std::string("\n") + kWorstHead;
    for (std::size_t i = 0; i < std::min(kWorstTests, tests.size()); ++i) {
      page += worst_row(tests[i]);
    }
  }
  if (!figure.empty()) {
    page += "\n![Candidate over baseline against averaging time, with margin and scope](" + figure + ")\n";
  }
  page += "\n<details><summary>More tests, sessions and settings</summary>\n\n";
  page += "- " + markdown_field(arm_line("Baseline", report.baseline)) + "\n- " +
          markdown_field(arm_line("Candidate", report.candidate)) + "\n- " + look_line(run.look) + "\n\n";
  const std::size_t shown = kWorstTests + kFoldedTests;
  if (tests.size() > kWorstTests) {
    page += kWorstHead;
    for (std::size_t i = kWorstTests; i < std::min(shown, tests.size()); ++i) {
      page += worst_row(tests[i]);
    }
    page += "\n" + more_line("", tests.size(), shown, "test", "units[].tests");
  }
  page += "\n</details>\n";
  return page;
}

std::string no_verdict_to_markdown(const std::string& sentence) {
  return "**ERROR**: " + markdown_field(sentence) + "\n" + kMarker + "The run ended without a verdict.\n";
}

}  // namespace driftlab
