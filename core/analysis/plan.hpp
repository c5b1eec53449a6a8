#pragma once
/// The use case "plan": the recordings of a study in, the recordings to make next out.
///
/// The study is investigated; what that leaves open is what the proposals are to decide
/// (core/investigate/plan_campaign.hpp).
#include "core/analysis/investigate.hpp"
#include "core/investigate/plan_campaign.hpp"

namespace driftlab {

struct PlanRequest {
  InvestigationRequest investigation;
  investigate::PlanOptions options;
};

struct PlannedStudy {
  investigate::Report report;
  investigate::CampaignPlan plan;
};

/// Errors: those of investigate_study; InvalidArgument for no runs at all; Cancelled.
[[nodiscard]] Result<PlannedStudy> plan_study(const PlanRequest& request, RecordingSource& recordings,
                                              const RunControl& control = {});

}  // namespace driftlab
