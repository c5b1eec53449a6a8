#pragma once
/// The plan of a measurement campaign as lines for people.
#include "core/investigate/plan_campaign.hpp"

#include <string>

namespace driftlab {

/// What is open, and for each proposal what to record and how likely it decides what.
[[nodiscard]] std::string plan_to_text(const investigate::CampaignPlan& plan);

}  // namespace driftlab
