#pragma once
/// The arithmetic of figures: what they draw of a document's numbers that the document does not hold.
///
/// A document has deviations in the channel's unit, wavelet variances and coefficients in the units of the field; a
/// figure shows them in one unit, over one another, and read off at a round time. Values that are not known stay so
/// through every step.
#include "core/fit/characterisation.hpp"
#include "core/signal/unit.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

using Values = std::vector<std::optional<double>>;

/// A curve with the ends of its 95 % intervals; lists as long as `x`, or empty.
struct DrawnCurve {
  std::vector<double> x;
  Values y;
  Values low;
  Values high;
};

/// Each value times `factor`.
[[nodiscard]] Values scaled(Values values, double factor);
[[nodiscard]] DrawnCurve scaled(DrawnCurve curve, double factor);

/// Each value over that of `base`; nothing where either is missing or the base is not positive.
[[nodiscard]] Values over(const Values& values, const Values& base);

/// The unit in which deviations of a channel are drawn, and its size in units of the channel: deg/h and mg, the units
/// of bias instability (IEEE Std 952), else the channel's own.
struct DrawnUnit {
  std::string symbol;
  double factor = 1.0;  ///< a value in the channel's unit times this is one in `symbol`
};
[[nodiscard]] DrawnUnit drawn_unit(const std::string& channel_unit);

/// Allan deviations of Haar wavelet variances, sqrt(2 variance) times `factor`, of filters of `scale` samples, at tau =
/// scale dt/2. Variances below 0 have none; `variances.x` is not read.
[[nodiscard]] DrawnCurve deviations_of_wavelets(std::span<const std::size_t> scale, double dt_s, double factor,
                                                const DrawnCurve& variances);

/// The value of a curve at x, on a straight line between its points on both logarithms; at a point (to 1e-9) its own.
/// Nothing outside the curve and beside a value that is not known. `curve.x` rises and is positive. O(n).
[[nodiscard]] std::optional<double> read_at(const DrawnCurve& curve, double x);

/// `curve` over another one: over its value at the same x where `exact` has it, else over what is read off `model`.
[[nodiscard]] DrawnCurve relative_to(const DrawnCurve& curve, const DrawnCurve& exact, const DrawnCurve& model);

/// The Allan deviation of flicker noise B at its floor, sqrt(2 ln 2/pi) B = 0.664 B (IEEE Std 952), in the unit drawn.
/// `bias`: B in the unit of the field for a channel of that dimension.
[[nodiscard]] double bias_floor(double bias, const Unit& channel, const DrawnUnit& drawn);

/// Where the level of a process is read off its curve.
struct LevelPlace {
  double tau_s = 0.0;
  double deviation = 0.0;
};

/// The Allan deviation of a process by itself (`curve`) at the averaging time at which it equals the level: a white
/// noise at 1 s, sqrt(AV) = N/sqrt(tau), and a random walk at 3 s, sqrt(AV) = K sqrt(tau/3) (IEEE Std 952, C.1.1 and
/// C.1.3). Nothing of other processes, outside the taus that were `measured` (rising, not empty), and where the curve
/// says nothing.
[[nodiscard]] std::optional<LevelPlace> level_place(std::string_view process, const DrawnCurve& curve,
                                                    std::span<const double> measured_tau_s);

/// Whether the robust deviations are worth drawing beside the classical ones: they differ at some scale, or gross
/// errors move the variances.
[[nodiscard]] bool robust_differs(const Contamination& contamination);

/// How far ratios are from 1: the greatest |ln ratio|, and at least `least`. Those not positive are passed over.
[[nodiscard]] double farthest_log(const Values& ratios, double least);

/// The factor from 1 to the end of an axis of ratios that are at most exp(`farthest`) from it: exp(widening farthest),
/// and no more than `most`.
[[nodiscard]] double end_of_ratios(double farthest, double widening,
                                   double most = std::numeric_limits<double>::infinity());

/// The greatest of `least`, margin times each ratio and margin over each; those not positive are passed over.
[[nodiscard]] double reach_of_ratios(const Values& ratios, double margin, double least);

/// Rows of a table by the size of their rate or acceleration, 0 where there is none.
[[nodiscard]] double size_of_dynamics(const std::optional<double>& value);

}  // namespace driftlab
