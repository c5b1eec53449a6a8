#pragma once
/// The equations of the causes of spec/causes.md, written down a second time: what an injected effect must look like.
///
/// Nothing here uses the template, the process or the driver with which a cause looks for itself. Mean effects are
/// written as functions of the motion in closed form, from which the test also writes the recording's columns in their
/// lab units; random effects are held to their moments.
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/showing.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::hidden {

/// What the test moves a sensor through, in closed form and SI.
namespace motion {
inline constexpr double kHeadingDeg = 75.0;   ///< the condition states it too
[[nodiscard]] double rate(double t);          ///< about z [rad/s]
[[nodiscard]] double acceleration(double t);  ///< its derivative
[[nodiscard]] double angle(double t);         ///< its integral from 0
[[nodiscard]] double force(double t);         ///< along z [m/s^2]: a slow part and vibration that comes and goes
[[nodiscard]] double temperature(double t);   ///< [K]
/// The temperature behind a first-order lag that is settled at t = 0.
[[nodiscard]] double lagged_temperature(double t, double lag_s);
}  // namespace motion

/// One channel before and after an effect has been put into it.
struct Injected {
  const investigate::Draft& before;
  const investigate::Draft& after;
  const investigate::Draft& other;  ///< another axis of the same recording after the same injection
  std::span<const double> values;
  /// The same draft injected with another seed.
  std::function<investigate::Draft(std::uint64_t seed)> again;

  [[nodiscard]] std::size_t samples() const { return before.white.size(); }
  [[nodiscard]] double dt_s() const { return before.recording->dt_s; }
  [[nodiscard]] std::size_t axis() const { return before.group->axis(); }
  /// What was added to the sum of all parts.
  [[nodiscard]] std::vector<double> added() const;
};

/// A cause with values of its parameters at which its figures are sharp.
struct Equation {
  std::string_view cause;
  std::vector<double> values;
  /// The unit of `values`, of all parameters that the cause declares: SI but for an angle of the compass; `y` is that
  /// of the channel's readings (reported.hpp reads it).
  std::vector<std::string_view> units;
  std::vector<investigate::Figure> (*figures)(const Injected& injected);
};

/// Root mean square of `seen` minus `expected` over that of `expected`: 0 where the equation holds.
[[nodiscard]] investigate::Figure deviation(std::string what, const std::vector<double>& seen,
                                            const std::vector<double>& expected, double tolerance);

[[nodiscard]] const std::vector<Equation>& equations();

/// Those of what is wrong with recordings as a whole (recording_equations.cpp); `equations` holds them too.
[[nodiscard]] std::vector<Equation> recording_equations();
/// Those of effects on the mean (mean_equations.cpp); likewise.
[[nodiscard]] std::vector<Equation> mean_equations();
/// Those of oscillations that are no line (oscillation_equations.cpp); likewise.
[[nodiscard]] std::vector<Equation> oscillation_equations();

}  // namespace driftlab::hidden
