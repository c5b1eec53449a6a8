#pragma once
/// A motion on the rotating Earth: true position, velocity and attitude, and the output of an ideal inertial unit.
///
/// Position: d latitude/dt = v_N/(M + h), d longitude/dt = v_E/((N + h) cos latitude), d height/dt = -v_D, by the
/// classical Runge-Kutta method at the output rate (error below 1e-9 m over minutes). With C the attitude b -> e,
///   f_b     = C^T (dv_e/dt + 2 w_ie x v_e - g(r)),
///   w_ib,b  = w_nb,b + C_bn (w_ie + w_en)        (Titterton and Weston 2004, ch. 3),
/// where dv_e/dt = C_en (dv_n/dt + w_en x v_n). Positions and attitudes are never differenced. The ideal output of a
/// sample is the mean of both over the interval that ends with it (Gauss-Legendre quadrature with three points, error
/// of order dt^6), as an integrating unit outputs it.
#include "core/navigate/motion.hpp"
#include "core/signal/result.hpp"

#include <array>
#include <cstddef>
#include <stop_token>
#include <vector>

namespace driftlab {

/// Mean over one sample interval: angular rate [rad/s] x, y, z, then specific force [m/s^2] x, y, z, body axes.
using ImuSample = std::array<double, 6>;

inline constexpr std::size_t kImuChannels = 6;

/// Where the body is, how it moves and how it points.
struct NavigationState {
  Vector3 position_ecef_m = Vector3::Zero();
  Vector3 velocity_ecef_m_s = Vector3::Zero();
  Quaternion attitude = Quaternion::Identity();  ///< b -> e
};

/// `states` has one member more than `imu`: imu[i] leads from states[i] to states[i + 1].
struct Trajectory {
  double dt_s = 0.0;
  std::vector<NavigationState> states;
  std::vector<ImuSample> imu;
};

/// Errors: InvalidArgument (rate not positive), LimitExceeded (more than 10 million samples), OutOfRange (the path
/// crosses a pole), Cancelled. 100 000 samples take a fifth of a second.
[[nodiscard]] Result<Trajectory> make_trajectory(const Motion& motion, double rate_hz,
                                                 const std::stop_token& stop = {});

/// Angular rate and specific force in the body axes at one moment, for a body at `place`.
[[nodiscard]] ImuSample ideal_imu(const MotionState& state, const Geodetic& place);

}  // namespace driftlab
