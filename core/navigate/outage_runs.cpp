#include "core/navigate/outage_runs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::uint64_t kGnssStream = 8;  // channels of the inertial unit take 0 to 5 of 16 streams a run
constexpr std::uint64_t kInitialStream = 9;

/// The truth with a draw of the first estimate's uncertainty.
NavigationState first_estimate(const NavigationState& truth, const InitialUncertainty& initial, Random& random) {
  const Matrix3 axes = ned_axes(truth.position_ecef_m);
  const auto draw = [&](const Vector3& sd) -> Vector3 {
    const double north = sd.x() * random.normal();
    const double east = sd.y() * random.normal();
    return axes * Vector3(north, east, sd.z() * random.normal());
  };
  NavigationState estimate = truth;
  estimate.position_ecef_m += draw(initial.position_sd_m);
  estimate.velocity_ecef_m_s += draw(initial.velocity_sd_m_s);
  estimate.attitude =
      rotation(draw({initial.tilt_sd_rad, initial.tilt_sd_rad, initial.heading_sd_rad})) * truth.attitude;
  return estimate;
}

OutageScore score_of(NavigationFilter& filter, const NavigationState& truth) {
  const NavigationError error = error_of(filter.state(), truth);
  const Matrix3 axes = ned_axes(truth.position_ecef_m);
  const Matrix3 p = axes.transpose() * filter.covariance().navigation().block<3, 3>(0, 0) * axes;
  OutageScore score;
  score.north_m = error.position_ned_m.x();
  score.east_m = error.position_ned_m.y();
  score.var_north = p(0, 0);
  score.var_east = p(1, 1);
  score.cov_north_east = 0.5 * (p(0, 1) + p(1, 0));
  score.heading_rad = error.attitude_rad.z();
  score.tilt_rad = std::hypot(error.attitude_rad.x(), error.attitude_rad.y());
  return score;
}

/// North and east from the start, in the plane of the start.
void add_point(OutagePath& path, double time_s, const Vector3& position, const Vector3& start, const Matrix3& axes) {
  const Vector3 local = axes.transpose() * (position - start);
  path.time_s.push_back(time_s);
  path.north_m.push_back(local.x());
  path.east_m.push_back(local.y());
}

/// Moments at which a filter is interrupted, as numbers of samples done.
enum class EventKind {
  Point,
  Track,
  Score,
  Fix
};  // in this order at one moment: a score is taken before the returning fix
struct Event {
  std::size_t sample = 0;
  EventKind kind = EventKind::Point;
  std::size_t index = 0;  // of a point its second, of a fix or a score its own number, of a track its outage
  double time_s = 0.0;    // of a track
};

/// The moments of an outage's track that lie in the drive.
std::vector<double> track_times(const Outage& outage, double duration_s) {
  const auto first = static_cast<long>(std::ceil((outage.start_s - kTrackMarginS) * kTrackRateHz - 1e-6));
  const auto last = static_cast<long>(std::floor((outage.end_s() + kTrackMarginS) * kTrackRateHz + 1e-6));
  std::vector<double> times;
  for (long i = std::max(first, 0L); i <= last && static_cast<double>(i) <= duration_s * kTrackRateHz + 1e-6; ++i) {
    times.push_back(static_cast<double>(i) / kTrackRateHz);
  }
  return times;
}

std::vector<Event> events_of(const OutageScenario& scenario, const Trajectory& truth, const std::vector<GnssFix>& fixes,
                             bool drawn) {
  std::vector<Event> events;
  const auto sample_at = [&](double time_s) {
    return std::min(static_cast<std::size_t>(std::ceil(time_s / truth.dt_s - 1e-6)), truth.imu.size());
  };
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    events.push_back({sample_at(fixes[i].arrival_s), EventKind::Fix, i, 0.0});
  }
  for (std::size_t i = 0; i < scenario.outages.size(); ++i) {
    events.push_back({sample_at(scenario.outages[i].end_s()), EventKind::Score, i, 0.0});
  }
  const double duration_s = static_cast<double>(truth.imu.size()) * truth.dt_s;
  for (std::size_t s = 0; drawn && s <= static_cast<std::size_t>(duration_s); ++s) {
    events.push_back({sample_at(static_cast<double>(s)), EventKind::Point, s, 0.0});
  }
  for (std::size_t i = 0; drawn && i < scenario.outages.size(); ++i) {
    for (const double time_s : track_times(scenario.outages[i], duration_s)) {
      events.push_back({sample_at(time_s), EventKind::Track, i, time_s});
    }
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return a.sample != b.sample ? a.sample < b.sample : (a.kind != b.kind ? a.kind < b.kind : a.index < b.index);
  });
  return events;
}

}  // namespace

Result<OutageExperiment> OutageExperiment::make(const OutageScenario& scenario, const std::stop_token& stop) {
  if (auto status = check(scenario); !status) {
    return fail(status.error());
  }
  auto motion = make_motion(scenario);
  if (!motion) {
    return fail(motion.error());
  }
  auto truth = make_trajectory(**motion, scenario.imu_rate_hz, stop);
  if (!truth) {
    return fail(truth.error());
  }
  OutageExperiment experiment;
  experiment.scenario_ = scenario;
  experiment.truth_ = std::move(*truth);
  for (const FilterCandidate& candidate : scenario.filters) {
    auto design = FilterDesign::make(candidate.settings, experiment.truth_.dt_s);
    if (!design) {
      return fail(Error(design.error()).with("filter", candidate.name));
    }
    experiment.designs_.push_back(std::move(*design));
  }
  return experiment;
}

std::vector<std::vector<OutageScore>> OutageExperiment::run(std::uint64_t seed, std::uint64_t index, DrawnRun* drawn,
                                                            const std::stop_token& stop) const {
  const ImuRun imu = simulate_imu(truth_.imu, truth_.dt_s, scenario_.truth, scenario_.hardware, seed, index, stop);
  if (stop.stop_requested()) {
    return {};
  }
  const std::vector<GnssFix> arriving = fixes(seed, index);
  Random initial_random(seed, 16 * index + kInitialStream);
  const NavigationState start = first_estimate(truth_.states.front(), scenario_.initial, initial_random);
  const std::vector<Event> events = events_of(scenario_, truth_, arriving, drawn != nullptr);
  const Vector3 origin = truth_.states.front().position_ecef_m;
  const Matrix3 axes = ned_axes(origin);

  if (drawn != nullptr) {
    drawn->paths.assign(designs_.size(), {});
    drawn->tracks.assign(designs_.size(), std::vector<OutagePath>(scenario_.outages.size()));
  }
  std::vector<std::vector<OutageScore>> scores;
  for (std::size_t f = 0; f < designs_.size(); ++f) {
    NavigationFilter filter(designs_[f], start);
    std::vector<OutageScore> own(scenario_.outages.size());
    std::size_t done = 0;
    for (const Event& event : events) {
      filter.advance(std::span(imu.readings).subspan(done, event.sample - done));
      done = event.sample;
      switch (event.kind) {
        case EventKind::Point:
          add_point(drawn->paths[f], static_cast<double>(event.index), filter.state().position_ecef_m, origin, axes);
          break;
        case EventKind::Track:
          add_point(drawn->tracks[f][event.index], event.time_s, filter.state().position_ecef_m, origin, axes);
          break;
        case EventKind::Score:
          own[event.index] = score_of(filter, truth_.states[event.sample]);
          break;
        case EventKind::Fix:
          filter.update(arriving[event.index]);
          break;
      }
      if (stop.stop_requested()) {
        return {};
      }
    }
    scores.push_back(std::move(own));
  }
  return scores;
}

std::vector<GnssFix> OutageExperiment::fixes(std::uint64_t seed, std::uint64_t index) const {
  Random random(seed, 16 * index + kGnssStream);
  return simulate_gnss(truth_, scenario_.gnss, scenario_.outages, random);
}

OutagePath OutageExperiment::true_path() const {
  OutagePath path;
  const Vector3 origin = truth_.states.front().position_ecef_m;
  const Matrix3 axes = ned_axes(origin);
  for (std::size_t s = 0;; ++s) {
    const auto sample = static_cast<std::size_t>(std::llround(static_cast<double>(s) / truth_.dt_s));
    if (sample >= truth_.states.size()) {
      return path;
    }
    add_point(path, static_cast<double>(s), truth_.states[sample].position_ecef_m, origin, axes);
  }
}

std::vector<OutagePath> OutageExperiment::true_tracks() const {
  const Vector3 origin = truth_.states.front().position_ecef_m;
  const Matrix3 axes = ned_axes(origin);
  const double duration_s = static_cast<double>(truth_.imu.size()) * truth_.dt_s;
  std::vector<OutagePath> tracks;
  for (const Outage& outage : scenario_.outages) {
    OutagePath& track = tracks.emplace_back();
    for (const double time_s : track_times(outage, duration_s)) {
      const auto sample = static_cast<std::size_t>(std::llround(time_s / truth_.dt_s));
      add_point(track, time_s, truth_.states[std::min(sample, truth_.states.size() - 1)].position_ecef_m, origin, axes);
    }
  }
  return tracks;
}

}  // namespace driftlab
