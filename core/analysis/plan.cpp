#include "core/analysis/plan.hpp"

#include "core/analysis/load_study.hpp"

#include <deque>

namespace driftlab {

Result<PlannedStudy> plan_study(const PlanRequest& request, RecordingSource& recordings, const RunControl& control) {
  if (request.options.runs == 0) {
    return fail(ErrorCode::InvalidArgument, "A plan needs one simulated study or more for each question.",
                {{"parameter", "--runs"}});
  }
  std::deque<ColumnFile> columns;
  investigate::Study study;
  study.id = request.investigation.study;
  study.device = request.investigation.device;
  study.baseline = request.investigation.baseline;
  if (const Status loaded = load_study(recordings, columns, study, part_of(control, 0.0, 0.05)); !loaded) {
    return fail(loaded.error());
  }
  auto report = investigate::investigate(study, {.predict_outages = false}, part_of(control, 0.05, 0.15));
  if (!report) {
    return fail(report.error());
  }
  auto plan = investigate::plan_campaign(study, *report, request.options, part_of(control, 0.15, 1.0));
  if (!plan) {
    return fail(plan.error());
  }
  return PlannedStudy{*std::move(report), *std::move(plan)};
}

}  // namespace driftlab
