#include "core/navigate/outage_scenario.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

tl::unexpected<Error> bad(std::string why, const char* parameter) {
  return fail(ErrorCode::InvalidArgument, std::move(why), {{"parameter", parameter}});
}

Status check_outages(const OutageScenario& scenario) {
  if (scenario.outages.empty()) {
    return bad("The scenario has no outage.", "outages");
  }
  if (scenario.outages.size() > kMostOutages) {
    return bad("A scenario has at most 1000 outages.", "outages");
  }
  double before = 1.0 / scenario.gnss.rate_hz;
  for (const Outage& outage : scenario.outages) {
    if (!(outage.duration_s > 0.0 && outage.start_s >= before && outage.end_s() <= scenario.drive.duration_s)) {
      return bad(
          "Outages must last longer than 0 s, follow each other, begin after the first fix and end with the drive.",
          "outages");
    }
    before = outage.end_s();
  }
  return {};
}

}  // namespace

OutageScenario completed(WrittenScenario written) {
  OutageScenario scenario = std::move(written.scenario);
  scenario.recorded = std::move(written.recorded.poses);
  look_ahead(scenario.recorded, written.recorded.unknown);
  if (scenario.drive.duration_s == 0.0 && !scenario.recorded.empty()) {
    scenario.drive.duration_s = duration_of(scenario.recorded);
  }
  for (const Segment& segment : scenario.drive.segments) {
    if (written.at_turns_s && segment.kind == SegmentKind::Turn) {
      scenario.outages.push_back({segment.start_s, *written.at_turns_s});
    }
  }
  return scenario;
}

Result<std::unique_ptr<Motion>> make_motion(const OutageScenario& scenario) {
  if (scenario.recorded.empty()) {
    return make_segment_motion(scenario.drive);
  }
  auto motion = make_recorded_motion(scenario.drive.start, scenario.recorded);
  if (motion && !(scenario.drive.duration_s > 0.0 && scenario.drive.duration_s <= (*motion)->duration_s() + 1e-9)) {
    return bad("The drive lasts longer than its recorded poses.", "duration_s");
  }
  return motion;
}

Status check(const OutageScenario& scenario) {
  if (scenario.filters.empty() || scenario.filters.size() > 32) {
    return bad("The scenario needs 1 to 32 filters.", "filters");
  }
  for (auto filter = scenario.filters.begin(); filter != scenario.filters.end(); ++filter) {
    if (std::any_of(scenario.filters.begin(), filter,
                    [&](const FilterCandidate& f) { return f.name == filter->name; })) {
      return bad("Two filters are called " + filter->name + ".", "filters");
    }
  }
  if (!(scenario.imu_rate_hz >= 1.0 && scenario.imu_rate_hz <= 10000.0)) {
    return bad("The rate of the inertial unit must be 1 to 10000 Hz.", "imu_rate_hz");
  }
  if (scenario.drive.duration_s > 86400.0) {
    return bad("The drive must not be longer than a day.", "duration_s");
  }
  if (auto status = check(scenario.gnss); !status) {
    return status;
  }
  if (auto status = check(scenario.hardware); !status) {
    return status;
  }
  if (auto status = check_outages(scenario); !status) {
    return status;
  }
  if (scenario.drive.duration_s * scenario.imu_rate_hz >= 1e7) {
    return fail(ErrorCode::LimitExceeded, "The trajectory would have more than 10 million samples.",
                {{"limit", "10000000"}});
  }
  if (auto motion = make_motion(scenario); !motion) {
    return fail(motion.error());
  }
  for (const FilterCandidate& filter : scenario.filters) {
    if (auto status = FilterDesign::check(filter.settings, 1.0 / scenario.imu_rate_hz); !status) {
      return fail(Error(status.error()).with("filter", filter.name));
    }
  }
  return {};
}

}  // namespace driftlab
