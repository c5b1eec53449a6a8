#pragma once
/// The plan of a measurement campaign as lines for people.
#include "core/investigate/plan_campaign.hpp"

#include <string>

namespace driftlab {

/// The open questions, and for each proposal the recordings to make, the questions that it may decide and the
/// probability that it does.
[[nodiscard]] std::string plan_to_text(const investigate::CampaignPlan& plan);

}  // namespace driftlab
