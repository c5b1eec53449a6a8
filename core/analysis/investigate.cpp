#include "core/analysis/investigate.hpp"

#include "core/analysis/load_study.hpp"
#include "core/investigate/report/page.hpp"

#include <deque>

namespace driftlab {
namespace {

/// Of the progress; the rest is the search.
constexpr double kLoadShare = 0.1;

}  // namespace

Result<investigate::Report> investigate_study(const InvestigationRequest& request, RecordingSource& recordings,
                                              const RunControl& control) {
  std::deque<ColumnFile> columns;
  investigate::Study study;
  study.id = request.study;
  study.device = request.device;
  study.baseline = request.baseline;
  if (const Status loaded = load_study(recordings, columns, study, part_of(control, 0.0, kLoadShare)); !loaded) {
    return fail(loaded.error());
  }
  return investigate::investigate(study, request.options, part_of(control, kLoadShare, 1.0));
}

std::string investigation_page(const investigate::Report& report) { return investigate::markdown(report); }

}  // namespace driftlab
