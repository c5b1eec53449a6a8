/// The JUnit report of a regression run.
#include "core/signal/short_name.hpp"
#include "schema/text/regression.hpp"

#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace driftlab {
namespace {

using regression::ScaleReport;
using regression::UnitReport;

/// Text of an XML attribute or element; characters that XML 1.0 cannot hold become a question mark.
std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20U ? '?' : c;
    }
  }
  return out;
}

struct CaseCounts {
  std::size_t tests = 0;
  std::size_t failures = 0;
  std::size_t errors = 0;
  std::size_t skipped = 0;

  CaseCounts& operator+=(const CaseCounts& other) {
    tests += other.tests;
    failures += other.failures;
    errors += other.errors;
    skipped += other.skipped;
    return *this;
  }
};

class TestSuite {
 public:
  TestSuite(std::string classname, bool skip_open) : classname_(std::move(classname)), skip_open_(skip_open) {}

  void passed(const std::string& name) { add(name, ""); }
  void failed(const std::string& name, const std::string& sentence) {
    ++counts.failures;
    add(name, "<failure message=\"" + xml_text(sentence) + "\"/>");
  }
  void broken(const std::string& name, const std::string& sentence) {
    ++counts.errors;
    add(name, "<error type=\"no verdict\" message=\"" + xml_text(sentence) + "\"/>");
  }
  void open(const std::string& name, const std::string& sentence) {
    if (skip_open_) {
      ++counts.skipped;
      add(name, "<skipped message=\"" + xml_text(sentence) + "\"/>");
    } else {
      ++counts.errors;
      add(name, "<error type=\"inconclusive\" message=\"" + xml_text(sentence) + "\"/>");
    }
  }

  CaseCounts counts;
  std::string cases;
  std::string output;  ///< for people: tests that do not block

 private:
  void add(const std::string& name, const std::string& content) {
    ++counts.tests;
    cases += "    <testcase classname=\"" + xml_text(classname_) + "\" name=\"" + xml_text(name) + "\"" +
             (content.empty() ? "/>\n" : ">" + content + "</testcase>\n");
  }
  std::string classname_;
  bool skip_open_;
};

std::string name_of_test(const UnitReport& unit, const ScaleReport& test) {
  return short_sensor_name(unit.name) + " " +
         (test.name.empty() ? "at " + regression::duration_text(test.test.tau_s) : test.name);
}

std::string case_sentence(const UnitReport& unit, const ScaleReport& test) {
  return name_of_test(unit, test) + ": " +
         regression::interval_text(test.theta, test.outcome.lower, test.outcome.upper) + ", margin " +
         regression::percent_text(test.test.margin).substr(1);
}

void add_tests(const regression::Report& report, const std::string& condition, TestSuite& suite) {
  for (const UnitReport& unit : report.units) {
    if (unit.condition != condition) {
      continue;
    }
    for (const ScaleReport& test : unit.tests) {
      const std::string sentence = case_sentence(unit, test);
      const bool beyond = test.outcome.finding == regression::Finding::Beyond;
      if (beyond) {
        suite.failed(name_of_test(unit, test), sentence);
      } else if (!test.gated) {
        suite.output += sentence + " (watched: " + std::string(name_of(test.outcome.finding)) + ")\n";
      } else if (test.outcome.upper_one >= test.test.margin) {
        suite.open(name_of_test(unit, test), sentence);
      } else {
        suite.passed(name_of_test(unit, test));
      }
    }
  }
}

/// Event checks, what must agree for a comparison, and the verdict.
void add_run(const regression::Report& report, TestSuite& suite) {
  for (const regression::EventCheck& check : report.checks) {
    if (check.verdict == regression::CheckVerdict::Fail) {
      suite.failed(check.check, check.sentence);
    } else {
      suite.passed(check.check);
    }
  }
  for (const std::string_view item : regression::kComparedItems) {
    const std::string name = "comparable: " + std::string(item);
    std::string sentences;
    for (const regression::Incomparable& found : report.comparability) {
      sentences += found.item == item ? (sentences.empty() ? "" : " ") + found.sentence : "";
    }
    if (sentences.empty()) {
      suite.passed(name);
    } else {
      suite.open(name, sentences);
    }
  }
  switch (report.verdict) {
    case regression::Verdict::Pass:
      suite.passed("verdict");
      break;
    case regression::Verdict::Fail:
      suite.failed("verdict", report.summary.verdict);
      break;
    case regression::Verdict::Inconclusive:
      suite.open("verdict", report.summary.verdict);
  }
  suite.output = report.summary.verdict + "\n" + suite.output;
}

std::string numbers_of(const CaseCounts& counts) {
  return " tests=\"" + std::to_string(counts.tests) + "\" failures=\"" + std::to_string(counts.failures) +
         "\" errors=\"" + std::to_string(counts.errors) + "\" skipped=\"" + std::to_string(counts.skipped) + "\"";
}

std::string suite_text(const std::string& name, const TestSuite& suite) {
  return "  <testsuite name=\"" + xml_text(name) + "\"" + numbers_of(suite.counts) + ">\n" + suite.cases +
         "    <system-out>" + xml_text(suite.output) + "</system-out>\n  </testsuite>\n";
}

std::string junit_of(const CaseCounts& counts, const std::string& suites) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + numbers_of(counts) + ">\n" + suites +
         "</testsuites>\n";
}

}  // namespace

std::string no_verdict_to_junit(const std::string& sentence) {
  TestSuite suite("driftlab.regression", false);
  suite.broken("verdict", sentence);
  suite.output = sentence + "\n";
  return junit_of(suite.counts, suite_text("sensor noise", suite));
}

std::string regression_to_junit(const RegressReport& run, bool skip_open) {
  const regression::Report& report = run.report;
  std::set<std::string> conditions;
  for (const UnitReport& unit : report.units) {
    conditions.insert(unit.condition);
  }
  const std::string pair =
      report.candidate.label.empty() ? "" : ", " + report.baseline.label + " to " + report.candidate.label;
  CaseCounts all;
  std::string suites;
  const auto close = [&](const std::string& condition, const TestSuite& suite) {
    all += suite.counts;
    suites +=
        suite_text("sensor noise of " + report.device + (condition.empty() ? "" : ", " + condition) + pair, suite);
  };
  for (const std::string& condition : conditions) {
    TestSuite suite("driftlab.regression." + report.device, skip_open);
    add_tests(report, condition, suite);
    if (conditions.size() == 1) {
      add_run(report, suite);
    }
    close(condition, suite);
  }
  if (conditions.size() != 1) {
    TestSuite suite("driftlab.regression." + report.device, skip_open);
    add_run(report, suite);
    close("", suite);
  }
  return junit_of(all, suites);
}

}  // namespace driftlab
