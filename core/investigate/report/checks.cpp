#include "core/investigate/report/checks.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/name_list.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab::investigate {
namespace {

/// The level at which a check fails, after Holm (1979) over all checks of the study.
constexpr double kLevel = 0.05;

/// One p-value of a check, before or after.
struct Tested {
  double p = 1.0;
  double* adjusted = nullptr;
  bool* failed = nullptr;
};

/// Holm's step-down adjustment over all of them.
void adjust(std::vector<Tested> tested) {
  std::vector<std::size_t> order(tested.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(tested[a].p, a) < std::pair(tested[b].p, b); });
  double running = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Tested& one = tested[order[i]];
    running = std::max(running, std::min(1.0, one.p * static_cast<double>(order.size() - i)));
    *one.adjusted = running;
    *one.failed = running < kLevel;
  }
}

/// `causes`: how many such checks the study has.
double probability_of(const Evidence& evidence, std::size_t causes) {
  const double any = kLevel * std::exp(-0.5 * (evidence.score - kThreshold));
  return std::clamp(any / static_cast<double>(causes), 0.0, 1.0);
}

bool has_found(const GroupOutcome& outcome, const Evidence& evidence) {
  return std::any_of(outcome.found.begin(), outcome.found.end(),
                     [&](const Evidence& found) { return found.cause == evidence.cause; });
}

/// `causes`: how many such checks the study has.
Check cause_check(const Evidence& evidence, const ChannelGroup& group, const GroupOutcome& outcome,
                  std::size_t causes) {
  Check check;
  check.id = group.column + "." + std::string(evidence.cause->name);
  check.title = std::string(evidence.cause->title);
  check.recording = evidence.members.size() == 1 ? group.members[evidence.members.front()].recording->id : "";
  check.channel = group.column;
  check.observed = evidence.gain;
  const double dof = std::max(1.0, evidence.freedom);
  check.q025 = chi_squared_quantile(0.025, dof);
  check.median = chi_squared_quantile(0.5, dof);
  check.q975 = chi_squared_quantile(0.975, dof);
  const bool shown = evidence.cause->as<FileFact>() != nullptr && evidence.score > kThreshold;
  check.p = shown ? 0.0 : probability_of(evidence, causes);
  // Once it is in the model it has nothing more to say; what is not is judged as the search left it.
  const auto left = std::find_if(outcome.remaining.begin(), outcome.remaining.end(),
                                 [&](const Evidence& e) { return e.cause == evidence.cause; });
  if (left != outcome.remaining.end() && !has_found(outcome, evidence)) {
    check.observed_after = left->gain;
    check.p_after = probability_of(*left, causes);
  }
  return check;
}

/// The general checks of one channel before and after; where nothing was found they are the same.
std::vector<Check> before_and_after(const ChannelGroup& group, const GroupOutcome& outcome) {
  std::vector<Check> checks;
  std::vector<Check> later;
  general_checks(group, outcome.before, checks);
  if (!outcome.found.empty()) {
    general_checks(group, outcome.after, later);
  }
  for (Check& check : checks) {
    const auto same =
        std::find_if(later.begin(), later.end(), [&](const Check& other) { return other.id == check.id; });
    const Check& after = same != later.end() ? *same : check;
    check.observed_after = after.observed;
    check.p_after = after.p;
    check.excess_after = after.excess;
  }
  return checks;
}

/// The checks that fail with the extended model, per channel, in words.
void list_unexplained(const std::vector<ChannelGroup>& groups, Report& report) {
  for (const ChannelGroup& group : groups) {
    Unexplained left{group.column, "", {}};
    std::vector<std::string> titles;
    for (const Check& check : report.checks) {
      if (check.channel == group.column && check.failed_after) {
        left.checks.push_back(check.id);
        if (std::find(titles.begin(), titles.end(), check.title) == titles.end()) {
          titles.push_back(check.title);
        }
      }
    }
    if (left.checks.empty()) {
      continue;
    }
    left.sentence = "The extended model does not describe " + group.column + ": ";
    // Checks named in a sentence; the rest is counted. Chosen for who reads it.
    constexpr std::size_t kNamed = 4;
    NameList named(kNamed);
    for (const std::string& title : titles) {
      named.add(title);
    }
    left.sentence.append(named.text()).append(titles.size() == 1 ? " still disagrees" : " still disagree");
    left.sentence.append(", and no cause of the list explains what is left.");
    report.unexplained.push_back(std::move(left));
  }
}

}  // namespace

ChannelChecks check_channel(const ChannelGroup& group, const GroupOutcome& outcome) {
  ChannelChecks channel;
  if (!outcome.usable) {
    return channel;
  }
  channel.checks = before_and_after(group, outcome);
  for (std::size_t r = 0; r < outcome.after.members(); ++r) {
    channel.after.push_back(moments_of(outcome.after.innovation[r], outcome.after.used[r]));
  }
  return channel;
}

void make_checks(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes,
                 const std::vector<ChannelChecks>& channels, const std::vector<Evidence>& examined, Report& report) {
  std::vector<Check>& checks = report.checks;
  double misfit = 0.0;
  double samples = 0.0;
  std::vector<unsigned char> twice;  // tested again under the extended model
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<Check>& own = channels[g].checks;
    twice.insert(twice.end(), own.size(), outcomes[g].found.empty() ? 0 : 1);
    checks.insert(checks.end(), own.begin(), own.end());
    for (const InnovationMoments& m : channels[g].after) {
      misfit += 0.5 * m.count * (m.mean_square - 1.0);
      samples += m.count;
    }
  }
  report.misfit_after = samples > 0.0 ? misfit / samples : 0.0;
  for (const Evidence& evidence : examined) {
    checks.push_back(cause_check(evidence, groups[evidence.group], outcomes[evidence.group], examined.size()));
    twice.push_back(outcomes[evidence.group].found.empty() ? 0 : 1);
  }
  std::vector<Tested> tested;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    Check& check = checks[i];
    tested.push_back({check.p, &check.p_adjusted, &check.failed});
    if (twice[i] != 0) {
      tested.push_back({check.p_after, &check.p_after_adjusted, &check.failed_after});
    }
  }
  adjust(std::move(tested));
  for (std::size_t i = 0; i < checks.size(); ++i) {
    Check& check = checks[i];
    if (twice[i] == 0 && check.p_after < 1.0) {
      check.p_after_adjusted = check.p_adjusted;
      check.failed_after = check.failed;
    }
    report.failed_before += check.failed ? 1 : 0;
    report.failed_after += check.failed_after ? 1 : 0;
  }
  list_unexplained(groups, report);
}

std::vector<std::string> checks_behind(const Evidence& evidence, const std::vector<ChannelGroup>& groups,
                                       const Report& report) {
  std::vector<std::string> ids;
  const std::string own = groups[evidence.group].column + "." + std::string(evidence.cause->name);
  for (const Check& check : report.checks) {
    if (check.id == own && ids.empty()) {
      ids.push_back(check.id);
    }
  }
  std::vector<std::size_t> all{evidence.group};
  all.insert(all.end(), evidence.also_groups.begin(), evidence.also_groups.end());
  for (const std::size_t g : all) {
    for (const Check& check : report.checks) {
      const bool general =
          check.failed && check.channel == groups[g].column && check.id != own &&
          std::any_of(evidence.members.begin(), evidence.members.end(), [&](std::size_t r) {
            return r < groups[g].members.size() && check.id.rfind(groups[g].members[r].name() + ".", 0) == 0;
          });
      if (general) {
        ids.push_back(check.id);
      }
    }
  }
  return ids;
}

void settle_ends(Report& report) {
  for (Check& check : report.checks) {
    const bool behind = std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
      return std::find(finding.because.begin(), finding.because.end(), check.id) != finding.because.end();
    });
    check.end = check.failed_after       ? CheckEnd::Unexplained
                : check.failed && behind ? CheckEnd::Finding
                : check.failed           ? CheckEnd::Mended
                                         : CheckEnd::None;
  }
}

}  // namespace driftlab::investigate
