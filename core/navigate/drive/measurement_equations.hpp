#pragma once
/// The measurement equations of a drive: each measurement as a function of the filter's errors, linearised at the
/// present estimate.
///
/// The errors are those of the filter (navigation_filter.hpp): position, velocity and attitude in e, then the sensors'
/// states, then the constants that the options ask to be estimated. Body axes are forward, right, down; C is body to e,
/// w the turning rate of the body against the Earth.
#include "core/navigate/drive/drive.hpp"
#include "core/navigate/drive/filter_options.hpp"
#include "core/navigate/navigation_filter.hpp"

#include <array>
#include <vector>

namespace driftlab::drive {

/// Where the constants that a filter estimates stand among its sensor states; -1: it takes them as known.
struct ConstantLayout {
  int arm = -1, yaw = -1, axle = -1, odometer = -1, fixes = -1;
};

/// Standard deviations of the constants and their correlation times, 0 for what stays.
struct Constants {
  std::vector<double> sd, tau_s;
};

/// The constants that the options ask for; the first of them stands at `first`.
[[nodiscard]] Constants constants_of(const FilterOptions& options, ConstantLayout& layout, int first);

/// The filter at the moment of a measurement. Everything that it refers to must outlive it.
struct FilterMoment {
  const NavigationFilter& filter;
  const FilterOptions& options;
  const ConstantLayout& layout;
  Vector3 body_rate;  ///< w in body axes [rad/s]

  [[nodiscard]] double constant(int at) const { return at < 0 ? 0.0 : filter.sensor_states()(at); }
  /// From the unit to the antenna, as the filter has it.
  [[nodiscard]] Vector3 arm() const;
};

/// A fix's position [m], north, east, down, of a moment that is `late_s` ago.
[[nodiscard]] std::array<WideMeasurement, 3> position_equations(const FilterMoment& at, const Fix& fix, double late_s);

/// A fix's velocity [m/s], north, east, down, of a moment that is `late_s` ago.
[[nodiscard]] std::array<WideMeasurement, 3> velocity_equations(const FilterMoment& at, const Vector3& velocity_ned_m_s,
                                                                const Vector3& sd_m_s, double late_s);

/// A vehicle on its axle: velocity to the right and down [m/s], which measure `slip` where the truth has some.
[[nodiscard]] std::array<WideMeasurement, 2> constraint_equations(const FilterMoment& at, const Constraint& constraint,
                                                                  const std::array<double, 2>& slip);

/// Rest: velocity 0 [m/s], north, east, down.
[[nodiscard]] std::array<WideMeasurement, 3> rest_equations(const FilterMoment& at);

/// Rest of a vehicle on its wheels: it does not turn, so that what the gyroscope about down reads over `seconds` beside
/// the Earth's rate is its error and its noise [rad/s]. `mean_rate` is the mean reading about z, `design` the filter's.
[[nodiscard]] std::array<WideMeasurement, 1> no_turn_equations(const FilterMoment& at, const FilterDesign& design,
                                                               double mean_rate, double seconds);

/// The speed of a wheel [m/s].
[[nodiscard]] std::array<WideMeasurement, 1> odometer_equations(const FilterMoment& at, const OdometerSource& source,
                                                                double speed_m_s);

}  // namespace driftlab::drive
