#include "schema/json/campaign_plan.hpp"

#include "schema/json/recording_spec.hpp"

namespace driftlab {
namespace {

using investigate::CampaignPlan;
using investigate::Decision;
using investigate::Proposal;

Json decision_json(const Decision& decision, const CampaignPlan& plan) {
  const investigate::OpenQuestion& question = plan.open[decision.question];
  Json sizes = Json::object();
  for (const auto& size : decision.sizes) {
    sizes[size.name] = Json{{"value", number(size.estimate.value * size.unit.per_si)}, {"unit", size.unit.symbol}};
  }
  return Json{{"question", decision.question},
              {"cause", question.cause},
              {"rivals", question.rivals},
              {"sizes", std::move(sizes)},
              {"decided", decision.decided},
              {"runs", decision.runs},
              {"probability", quantity(decision.probability, 1.0, "1")}};
}

Json proposal_json(const Proposal& proposal, const CampaignPlan& plan) {
  Json conditions = Json::array();
  for (const Condition& condition : proposal.conditions) {
    conditions.push_back(to_json(condition));
  }
  Json decisions = Json::array();
  for (const Decision& decision : proposal.decisions) {
    decisions.push_back(decision_json(decision, plan));
  }
  return Json{{"title", proposal.title},
              {"channel", proposal.channel},
              {"conditions", std::move(conditions)},
              {"duration_s", number(proposal.duration_s)},
              {"rate_hz", number(proposal.rate_hz)},
              {"columns", proposal.columns},
              {"expected", number(proposal.expected())},
              {"decides", std::move(decisions)}};
}

}  // namespace

Json to_json(const CampaignPlan& plan) {
  Json open = Json::array();
  for (const auto& question : plan.open) {
    open.push_back(Json{{"cause", question.cause},
                        {"channel", question.channel},
                        {"kind", question.rivals.empty() ? "not_examined" : "ambiguous"},
                        {"rivals", question.rivals},
                        {"needs", question.needs}});
  }
  Json proposals = Json::array();
  for (const Proposal& proposal : plan.proposals) {
    proposals.push_back(proposal_json(proposal, plan));
  }
  return Json{{"open", std::move(open)}, {"proposals", std::move(proposals)}, {"undecided", plan.undecided}};
}

}  // namespace driftlab
