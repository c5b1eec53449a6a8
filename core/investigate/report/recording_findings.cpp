#include "core/investigate/report/recording_findings.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kCertain = 1000.0;  ///< score of a fact

Check certain_check(std::string id, std::string recording, std::string channel) {
  Check check;
  check.id = std::move(id);
  check.recording = std::move(recording);
  check.channel = std::move(channel);
  check.p = 0.0;
  check.p_adjusted = 0.0;
  check.failed = true;
  return check;
}

}  // namespace

void report_recordings(const RightedRecordings& righted, Report& report) {
  std::vector<Finding> findings;
  std::vector<Check> checks;
  for (const RecordingFinding& found : righted.findings) {
    Finding finding;
    finding.evidence.cause = found.cause;
    finding.evidence.score = finding.evidence.gain = kCertain;
    finding.evidence.parameters = found.fault.parameters;
    finding.channels = found.fault.channels;
    finding.everywhere = false;
    finding.explanation = found.fault.sentence;
    finding.gain.of_the_file = true;
    finding.gain.misfit_before = finding.gain.misfit_after = report.misfit_after;
    if (!found.fault.channels.empty()) {
      const ChannelName& name = found.fault.channels.front();
      checks.push_back(certain_check(name.text() + "." + std::string(found.cause->name), name.recording, name.column));
      checks.back().title = std::string(found.cause->title);
      checks.back().observed = 1.0;
      checks.back().end = CheckEnd::Finding;
      finding.because = {checks.back().id};
    }
    findings.push_back(std::move(finding));
  }
  for (const SetAside& aside : righted.aside) {
    Check check = certain_check(aside.recording + "/" + aside.channel + ".gain", aside.recording, aside.channel);
    check.observed = aside.gain;
    check.median = 1.0;
    check.q025 = 1.0 - 1.96 * aside.deviation;
    check.q975 = 1.0 + 1.96 * aside.deviation;
    check.title = "the gain on the motion that is stated";
    check.observed_after = check.observed;
    check.p_after = check.p_after_adjusted = 0.0;
    check.failed_after = true;
    check.end = CheckEnd::Unexplained;
    report.unexplained.push_back({aside.channel, aside.sentence, {check.id}});
    checks.push_back(std::move(check));
  }
  report.failed_before += checks.size();
  report.failed_after += righted.aside.size();
  report.findings.insert(report.findings.begin(), std::make_move_iterator(findings.begin()),
                         std::make_move_iterator(findings.end()));
  report.checks.insert(report.checks.begin(), std::make_move_iterator(checks.begin()),
                       std::make_move_iterator(checks.end()));
}

}  // namespace driftlab::investigate
