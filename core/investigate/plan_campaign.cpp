#include "core/investigate/plan_campaign.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/investigate/proposed_recordings.hpp"
#include "core/investigate/simulated_campaign.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// A share of `n` with Wilson's 95 % interval.
Estimate share_of(std::size_t k, std::size_t n) {
  // The 97.5 % quantile of a normal distribution.
  constexpr double kZ = 1.959964;
  const auto count = static_cast<double>(n);
  const double p = static_cast<double>(k) / count;
  const double d = 1.0 + kZ * kZ / count;
  const double centre = (p + 0.5 * kZ * kZ / count) / d;
  const double half = kZ / d * std::sqrt(p * (1.0 - p) / count + 0.25 * kZ * kZ / count / count);
  return {p, {std::max(0.0, centre - half), std::min(1.0, centre + half)}};
}

/// The investigation of a simulated study names the answer and nothing beside it.
bool decides(const Report& report, const std::string& cause, const std::string& column) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& finding) {
    const bool here = std::any_of(finding.channels.begin(), finding.channels.end(),
                                  [&](const ChannelName& channel) { return channel.column == column; });
    return here && finding.evidence.cause->name == cause && !finding.evidence.ambiguous;
  });
}

class Planner {
 public:
  Planner(const Study& study, const Report& report, const PlanOptions& options, const RunControl& control)
      : study_(study), report_(report), options_(options), control_(control), groups_(group_channels(study)) {}

  Result<CampaignPlan> run() {
    CampaignPlan plan;
    plan.open = open_questions(report_);
    std::size_t done = 0;
    for (const ChannelGroup& group : groups_) {
      std::deque<std::vector<double>> memory;
      for (const ProposedRecordings& recordings : proposed_recordings(group, memory)) {
        control_.report("plan " + group.column,
                        static_cast<double>(done++) / (5.0 * static_cast<double>(groups_.size())));
        Proposal proposal{recordings.title,
                          group.column,
                          recordings.conditions,
                          recordings.duration_s,
                          recordings.rate_hz,
                          recordings.columns,
                          {}};
        for (std::size_t q = 0; q < plan.open.size(); ++q) {
          if (control_.stop.stop_requested()) {
            return fail(ErrorCode::Cancelled, "The planning was stopped.");
          }
          if (plan.open[q].channel == group.column) {
            if (const Status tried = try_question(plan.open[q], q, group, recordings, proposal); !tried) {
              return fail(tried.error());
            }
          }
        }
        if (proposal.expected() > 0.0) {
          plan.proposals.push_back(std::move(proposal));
        }
      }
    }
    std::sort(plan.proposals.begin(), plan.proposals.end(), [](const Proposal& a, const Proposal& b) {
      return std::pair(-a.expected(), a.title) < std::pair(-b.expected(), b.title);
    });
    for (std::size_t q = 0; q < plan.open.size(); ++q) {
      const bool decided = std::any_of(plan.proposals.begin(), plan.proposals.end(), [&](const Proposal& proposal) {
        return std::any_of(proposal.decisions.begin(), proposal.decisions.end(),
                           [&](const Decision& decision) { return decision.question == q && decision.decided > 0; });
      });
      if (!decided) {
        plan.undecided.push_back(q);
      }
    }
    return plan;
  }

 private:
  Status try_question(const OpenQuestion& question, std::size_t number, const ChannelGroup& group,
                      const ProposedRecordings& recordings, Proposal& proposal) const {
    const SimulatedCampaign campaign(study_, report_, group, recordings.blank);
    const std::vector<Answer> answers = campaign.answers_to(question);
    if (answers.empty()) {
      return {};
    }
    Decision decision;
    decision.question = number;
    decision.sizes = answers.front().sizes;
    for (std::size_t run = 0; run < options_.runs; ++run) {
      const Answer& answer = answers[run % answers.size()];
      const SimulatedStudy simulated = campaign.simulate(answer, options_.seed + 1000 * run);
      auto report = investigate(simulated.study, {.predict_outages = false}, control_.reporting({}));
      if (!report) {
        return fail(report.error());
      }
      decision.decided += decides(*report, answer.effect.cause, group.column) ? 1 : 0;
      ++decision.runs;
    }
    decision.probability = share_of(decision.decided, decision.runs);
    proposal.decisions.push_back(std::move(decision));
    return {};
  }

  const Study& study_;
  const Report& report_;
  const PlanOptions& options_;
  const RunControl& control_;
  std::vector<ChannelGroup> groups_;
};

}  // namespace

double Proposal::expected() const {
  double sum = 0.0;
  for (const Decision& decision : decisions) {
    sum += decision.probability.value;
  }
  return sum;
}

std::vector<OpenQuestion> open_questions(const Report& report) {
  std::vector<OpenQuestion> open;
  const auto add = [&](OpenQuestion question) {
    const bool there = std::any_of(open.begin(), open.end(), [&](const OpenQuestion& other) {
      return other.cause == question.cause && other.channel == question.channel;
    });
    if (!there) {
      open.push_back(std::move(question));
    }
  };
  for (const Finding& finding : report.findings) {
    if (!finding.evidence.ambiguous || finding.channels.empty()) {
      continue;
    }
    OpenQuestion question{std::string(finding.evidence.cause->name), finding.channels.front().column, {}, ""};
    for (const Evidence& rival : finding.evidence.rivals) {
      question.rivals.emplace_back(rival.cause->name);
    }
    question.needs = finding.next_measurement;
    add(std::move(question));
  }
  for (const NotExamined& item : report.not_examined) {
    add({item.cause, item.channel, {}, item.needs});
  }
  return open;
}

Result<CampaignPlan> plan_campaign(const Study& study, const Report& report, const PlanOptions& options,
                                   const RunControl& control) {
  return Planner(study, report, options, control).run();
}

}  // namespace driftlab::investigate
