#pragma once
/// The job kind `outage_evaluation`: filters compared through simulated GNSS outages
/// (core/navigate/outage_evaluation.hpp).
///
/// `inputs`: {"scenario": NAME or document}; a sensor or axis of the document may be {"fit": "fit_..."}, a stored fit,
/// or {"table": {"device", "axis", "method", "model", "schedule", "hysteresis_deg_s", "step_deg_s"}}, the models of a
/// device's parameter table by |rate| (schema/json/table_schedule.hpp); what they hold is written into the request when
/// it is queued. `parameters`: {"runs", "seed", "relative_precision"}, all
/// optional.
#include "server/jobs/job_kind.hpp"

#include <memory>

namespace driftlab::server {

inline constexpr std::string_view kOutageEvaluationKind = "outage_evaluation";

[[nodiscard]] std::unique_ptr<JobKind> make_outage_evaluation_kind();

}  // namespace driftlab::server
