#pragma once
/// The plan of a measurement campaign as a document (schema/campaign-plan.schema.json).
#include "core/investigate/plan_campaign.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const investigate::CampaignPlan& plan);

}  // namespace driftlab
