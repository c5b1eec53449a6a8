#include "core/navigate/trajectory.hpp"

#include <cmath>

namespace driftlab {
namespace {

struct PlaceRate {
  double latitude = 0.0;
  double longitude = 0.0;
  double height = 0.0;
};

PlaceRate place_rate(const Geodetic& place, const Vector3& v) {
  return {v.x() / (meridian_radius(place.latitude_rad) + place.height_m),
          v.y() / ((prime_vertical_radius(place.latitude_rad) + place.height_m) * std::cos(place.latitude_rad)),
          -v.z()};
}

Geodetic moved(const Geodetic& place, const PlaceRate& rate, double dt_s) {
  return {place.latitude_rad + rate.latitude * dt_s, place.longitude_rad + rate.longitude * dt_s,
          place.height_m + rate.height * dt_s};
}

/// One classical Runge-Kutta step.
Geodetic advance(const Geodetic& place, const Motion& motion, double time_s, double dt_s) {
  const Vector3 v0 = motion.at(time_s).velocity_ned_m_s;
  const Vector3 v1 = motion.at(time_s + 0.5 * dt_s).velocity_ned_m_s;
  const Vector3 v2 = motion.at(time_s + dt_s).velocity_ned_m_s;
  const PlaceRate a = place_rate(place, v0);
  const PlaceRate b = place_rate(moved(place, a, 0.5 * dt_s), v1);
  const PlaceRate c = place_rate(moved(place, b, 0.5 * dt_s), v1);
  const PlaceRate d = place_rate(moved(place, c, dt_s), v2);
  const auto mean = [](double w, double x, double y, double z) { return (w + 2.0 * x + 2.0 * y + z) / 6.0; };
  return moved(place,
               {mean(a.latitude, b.latitude, c.latitude, d.latitude),
                mean(a.longitude, b.longitude, c.longitude, d.longitude), mean(a.height, b.height, c.height, d.height)},
               dt_s);
}

NavigationState state_at(const MotionState& motion, const Geodetic& place) {
  const Matrix3 axes = ned_axes(place.latitude_rad, place.longitude_rad);
  NavigationState state;
  state.position_ecef_m = to_ecef(place);
  state.velocity_ecef_m_s = axes * motion.velocity_ned_m_s;
  state.attitude = Quaternion(axes) * from_euler(motion.attitude);
  state.attitude.normalize();
  return state;
}

}  // namespace

ImuSample ideal_imu(const MotionState& state, const Geodetic& place) {
  const double sp = std::sin(place.latitude_rad);
  const double cp = std::cos(place.latitude_rad);
  const PlaceRate rate = place_rate(place, state.velocity_ned_m_s);
  const Vector3 earth_n(kEarthRate * cp, 0.0, -kEarthRate * sp);
  const Vector3 transport_n(rate.longitude * cp, -rate.latitude, -rate.longitude * sp);
  const Matrix3 axes = ned_axes(place.latitude_rad, place.longitude_rad);
  const Vector3 gravity_n = axes.transpose() * normal_gravity(to_ecef(place));
  const Vector3 force_n =
      state.acceleration_ned_m_s2 + (2.0 * earth_n + transport_n).cross(state.velocity_ned_m_s) - gravity_n;
  // Body rates from Euler rates (Titterton and Weston 2004, eq. 3.52).
  const double sr = std::sin(state.attitude.roll_rad);
  const double cr = std::cos(state.attitude.roll_rad);
  const double st = std::sin(state.attitude.pitch_rad);
  const double ct = std::cos(state.attitude.pitch_rad);
  const EulerAngles& d = state.attitude_rate;
  const Vector3 turning_b(d.roll_rad - d.heading_rad * st, d.pitch_rad * cr + d.heading_rad * sr * ct,
                          -d.pitch_rad * sr + d.heading_rad * cr * ct);
  const Quaternion to_body = from_euler(state.attitude).conjugate();
  const Vector3 rate_b = turning_b + to_body * (earth_n + transport_n);
  const Vector3 force_b = to_body * force_n;
  return {rate_b.x(), rate_b.y(), rate_b.z(), force_b.x(), force_b.y(), force_b.z()};
}

Result<Trajectory> make_trajectory(const Motion& motion, double rate_hz, const std::stop_token& stop) {
  if (!(rate_hz > 0.0 && std::isfinite(rate_hz))) {
    return fail(ErrorCode::InvalidArgument, "The sampling rate must be above 0.", {{"parameter", "imu_rate_hz"}});
  }
  const double exact = motion.duration_s() * rate_hz;
  if (!(exact < 1e7)) {
    return fail(ErrorCode::LimitExceeded, "The trajectory would have more than 10 million samples.",
                {{"limit", "10000000"}});
  }
  const auto count = static_cast<std::size_t>(std::floor(exact + 1e-6));
  Trajectory trajectory;
  trajectory.dt_s = 1.0 / rate_hz;
  trajectory.states.reserve(count + 1);
  trajectory.imu.reserve(count);
  Geodetic place = motion.start();
  trajectory.states.push_back(state_at(motion.at(0.0), place));
  const double offset = std::sqrt(0.6);
  constexpr std::array kWeights{5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0};
  constexpr std::size_t kBetweenLooks = 4096;  // samples: a few milliseconds
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kBetweenLooks == 0 && stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The trajectory was given up on request.");
    }
    const double time = static_cast<double>(i) / rate_hz;
    const double next_time = static_cast<double>(i + 1) / rate_hz;
    const Geodetic next = advance(place, motion, time, next_time - time);
    ImuSample mean{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double u = 0.5 * (1.0 + (static_cast<double>(k) - 1.0) * offset);
      const Geodetic between{place.latitude_rad + u * (next.latitude_rad - place.latitude_rad),
                             place.longitude_rad + u * (next.longitude_rad - place.longitude_rad),
                             place.height_m + u * (next.height_m - place.height_m)};
      const ImuSample moment = ideal_imu(motion.at(time + u * (next_time - time)), between);
      for (std::size_t c = 0; c < kImuChannels; ++c) {
        mean[c] += kWeights[k] * moment[c];
      }
    }
    place = next;
    if (!(std::fabs(place.latitude_rad) < 1.5707)) {
      return fail(ErrorCode::OutOfRange, "The trajectory leads over a pole, where north has no meaning.");
    }
    trajectory.imu.push_back(mean);
    trajectory.states.push_back(state_at(motion.at(next_time), place));
  }
  return trajectory;
}

}  // namespace driftlab
