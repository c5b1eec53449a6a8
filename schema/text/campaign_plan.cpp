#include "schema/text/campaign_plan.hpp"

#include "core/investigate/report/explain.hpp"
#include "core/signal/significant.hpp"

#include <map>

namespace driftlab {
namespace {

using investigate::CampaignPlan;
using investigate::Decision;
using investigate::OpenQuestion;
using investigate::Proposal;

std::string question_in_words(const OpenQuestion& question) {
  return question.rivals.empty() ? question.cause : question.cause + " or " + investigate::list_of(question.rivals);
}

void append_decision(const Decision& decision, const CampaignPlan& plan, std::string& text) {
  const OpenQuestion& question = plan.open[decision.question];
  text.append("   ").append(significant(100.0 * decision.probability.value)).append(" % ");
  text.append("(").append(std::to_string(decision.decided)).append(" of ").append(std::to_string(decision.runs));
  text.append(") ").append(question_in_words(question));
  for (std::size_t k = 0; k < decision.sizes.size(); ++k) {
    const auto& size = decision.sizes[k];
    text.append(k == 0 ? (question.rivals.empty() ? ", from " : ", ") : ", ").append(size.name).append(" = ");
    text.append(significant(size.estimate.value * size.unit.per_si));
    text.append(size.unit.symbol == "1" ? "" : " " + size.unit.symbol);
  }
  text.append("\n");
}

void append_proposal(const Proposal& proposal, const CampaignPlan& plan, std::string& text) {
  std::vector<std::string> conditions;
  for (const Condition& condition : proposal.conditions) {
    conditions.push_back(label(condition));
  }
  text.append(proposal.title).append(" (").append(investigate::list_of(conditions)).append("), ");
  text.append(significant(proposal.duration_s)).append(" s").append(proposal.conditions.size() > 1 ? " each" : "");
  text.append(" at ").append(significant(proposal.rate_hz)).append(" Hz; columns: ");
  text.append(investigate::list_of(proposal.columns)).append("\n");
  for (const Decision& decision : proposal.decisions) {
    append_decision(decision, plan, text);
  }
}

}  // namespace

std::string plan_to_text(const CampaignPlan& plan) {
  if (plan.open.empty()) {
    return "Nothing is open: no finding is ambiguous and every cause could be examined.\n";
  }
  std::string text = plan.proposals.empty() ? "No recording that was simulated decides what is open.\n"
                                            : "Recordings to make next, those that decide most first:\n";
  int number = 1;
  for (const Proposal& proposal : plan.proposals) {
    text.append("\n").append(std::to_string(number++)).append(". ");
    append_proposal(proposal, plan, text);
  }
  std::map<std::string, std::vector<std::string>> left;  // by what they need
  for (const std::size_t q : plan.undecided) {
    const OpenQuestion& question = plan.open[q];
    left[question.needs].push_back(question_in_words(question) + " of " + question.channel);
  }
  if (!left.empty()) {
    text.append("\nStill open after any of them:\n");
  }
  for (const auto& [needs, questions] : left) {
    text.append("- ").append(investigate::list_of(questions));
    text.append(needs.empty() ? "" : ", for want of " + needs).append("\n");
  }
  return text;
}

}  // namespace driftlab
