#pragma once
/// The measurement equations of a drive: each measurement as a function of the filter's errors, linearised at the
/// present estimate.
///
/// The errors are those of the filter (navigation_filter.hpp): position, velocity and attitude in e, then the sensors'
/// states, then the constants that the options ask to be estimated. Body axes are forward, right, down; C is body to e,
/// w the turning rate of the body against the Earth.
///
/// The equations take every constant from the options. How a measurement depends on one that is estimated is found by
/// turning it (with_constants), so that none of them is written into the filter.
#include "core/navigate/drive/drive.hpp"
#include "core/navigate/drive/filter_options.hpp"
#include "core/navigate/navigation_filter.hpp"

#include <array>
#include <vector>

namespace driftlab::drive {

/// Standard deviations of the constants and their correlation times, 0 for what stays: those that the options ask for
/// in their order, then, where errors of positions last, these along north, east and down.
struct Constants {
  std::vector<double> sd, tau_s;
};
[[nodiscard]] Constants constants_of(const FilterOptions& options);

/// The filter at the moment of a measurement. Everything that it refers to must outlive it.
struct FilterMoment {
  const NavigationFilter& filter;
  const FilterOptions& options;  ///< with the constants as the filter has them
  Vector3 body_rate;             ///< w in body axes [rad/s]
  int first_constant = 0;        ///< among the filter's sensor states
};

/// The options with every estimated constant as the filter has it.
[[nodiscard]] FilterOptions at_estimates(const FilterOptions& options, const NavigationFilter& filter,
                                         int first_constant);

/// `equations` of a moment, and how the measurements depend on each estimated constant x: dz/dx by the difference of
/// the innovations at x - h and x + h, h a thousandth of its standard deviation. O(constants) times the equations.
template <class Equations>
[[nodiscard]] auto with_constants(const FilterMoment& at, const Equations& equations) {
  auto measurements = equations(at);
  for (std::size_t k = 0; k < at.options.constants.size(); ++k) {
    const EstimatedConstant& constant = at.options.constants[k];
    const double step = 1e-3 * constant.sd;
    FilterOptions below = at.options;
    FilterOptions above = at.options;
    constant.turn(below, -step);
    constant.turn(above, step);
    const auto of_below = equations(FilterMoment{at.filter, below, at.body_rate, at.first_constant});
    const auto of_above = equations(FilterMoment{at.filter, above, at.body_rate, at.first_constant});
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const double change = of_below[i].navigation.innovation - of_above[i].navigation.innovation;
      if (change != 0.0) {
        measurements[i].add(at.first_constant + static_cast<int>(k), change / (2.0 * step));
      }
    }
  }
  return measurements;
}

/// A fix's position [m], north, east, down, of a moment that is `late_s` ago.
[[nodiscard]] std::array<WideMeasurement, 3> position_equations(const FilterMoment& at, const Fix& fix, double late_s);

/// A fix's velocity [m/s], north, east, down, of a moment that is `late_s` ago. `more_body_m_s`, in body axes: by how
/// much a receiver's velocity, which is a mean, differs from that of the moment.
[[nodiscard]] std::array<WideMeasurement, 3> velocity_equations(const FilterMoment& at, const Vector3& velocity_ned_m_s,
                                                                const Vector3& sd_m_s, double late_s,
                                                                const Vector3& more_body_m_s = Vector3::Zero());

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
