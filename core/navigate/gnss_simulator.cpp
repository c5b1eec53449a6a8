#include "core/navigate/gnss_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

Vector3 draw(Random& random, const Vector3& sd) {
  const double north = sd.x() * random.normal();
  const double east = sd.y() * random.normal();
  return {north, east, sd.z() * random.normal()};
}

}  // namespace

Status check(const GnssModel& model) {
  const auto bad = [](const char* member) {
    return fail(ErrorCode::InvalidArgument, "The receiver's " + std::string(member) + " is not a possible value.",
                {{"parameter", member}});
  };
  if (!(model.rate_hz > 0.0 && model.rate_hz <= 1000.0)) {
    return bad("rate_hz");
  }
  if (!(model.position_sd_m.allFinite() && model.position_sd_m.minCoeff() > 0.0)) {
    return bad("position_sd_m");
  }
  if (!(model.velocity_sd_m_s.allFinite() && model.velocity_sd_m_s.minCoeff() > 0.0)) {
    return bad("velocity_sd_m_s");
  }
  if (!(model.correlated_sd_m.allFinite() && model.correlated_sd_m.minCoeff() >= 0.0) ||
      (model.correlated_sd_m.maxCoeff() > 0.0 && !(model.correlation_time_s > 0.0))) {
    return bad("correlated_sd_m");
  }
  if (!(model.latency_s >= 0.0 && model.latency_s < 10.0)) {
    return bad("latency_s");
  }
  if (!model.lever_arm_m.allFinite()) {
    return bad("lever_arm_m");
  }
  return {};
}

std::vector<GnssFix> simulate_gnss(const Trajectory& trajectory, const GnssModel& model,
                                   const std::vector<Outage>& outages, Random& random) {
  std::vector<GnssFix> fixes;
  const double period = 1.0 / model.rate_hz;
  const double end = static_cast<double>(trajectory.imu.size()) * trajectory.dt_s;
  const double decay = model.correlation_time_s > 0.0 ? std::exp(-period / model.correlation_time_s) : 0.0;
  Vector3 wander = draw(random, model.correlated_sd_m);
  for (std::size_t k = 1; static_cast<double>(k) * period <= end + 1e-9; ++k) {
    const double validity = static_cast<double>(k) / model.rate_hz;
    const Vector3 position_error = draw(random, model.position_sd_m);
    const Vector3 velocity_error = draw(random, model.velocity_sd_m_s);
    wander = decay * wander + std::sqrt(1.0 - decay * decay) * draw(random, model.correlated_sd_m);
    const double arrival = validity + model.latency_s;
    if (std::any_of(outages.begin(), outages.end(), [&](const Outage& o) { return o.covers(arrival); }) ||
        arrival > end + 1e-9) {
      continue;
    }
    const auto nearest = static_cast<std::size_t>(std::llround(validity / trajectory.dt_s));
    const NavigationState& state = trajectory.states[std::min(nearest, trajectory.imu.size())];
    const double late = validity - static_cast<double>(nearest) * trajectory.dt_s;
    const Matrix3 axes = ned_axes(state.position_ecef_m);
    const ImuSample& motion = trajectory.imu[std::min(nearest, trajectory.imu.size() - 1)];
    const Vector3 turning = Vector3(motion[0], motion[1], motion[2]) - (state.attitude.conjugate() * earth_rate());
    GnssFix fix;
    fix.arrival_s = arrival;
    fix.validity_s = validity;
    fix.position_ecef_m = state.position_ecef_m + late * state.velocity_ecef_m_s + state.attitude * model.lever_arm_m +
                          axes * (position_error + wander);
    fix.velocity_ecef_m_s =
        state.velocity_ecef_m_s + state.attitude * turning.cross(model.lever_arm_m) + axes * velocity_error;
    fix.position_sd_m = (model.position_sd_m.array().square() + model.correlated_sd_m.array().square()).sqrt();
    fix.velocity_sd_m_s = model.velocity_sd_m_s;
    fixes.push_back(fix);
  }
  return fixes;
}

}  // namespace driftlab
