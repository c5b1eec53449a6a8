#pragma once
/// Innovations whose variance depends on a driver: their squares by level of the driver, and a one-parameter model
/// fitted to them.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/signal/estimate.hpp"

#include <functional>
#include <vector>

namespace driftlab::investigate {

/// Sums of squared innovations by level u of a driver: sufficient for any variance that depends on u alone.
struct Modulation {
  std::vector<double> u, count, square;
  double largest = 0.0;
  std::size_t distinct = 0;  ///< levels that hold samples
};

/// Levels of |driver| (60 between 0 and its largest). `driver` picks a grid vector of a recording for the group's axis
/// (z for accelerometers); recordings without it count as 0.
[[nodiscard]] Modulation modulation_of(
    const FullRate& data, const std::function<const Series*(const StudyRecording&, std::size_t axis)>& driver);

/// Two levels: 1 in the recordings of the scope, 0 outside.
[[nodiscard]] Modulation modulation_of_scope(const FullRate& data, const std::vector<std::size_t>& scope);

struct ModulationFit {
  double value = 0.0;
  Interval interval;   ///< 95 %, profile likelihood
  double gain = 0.0;   ///< twice the log likelihood gained over value 0
  double scale = 1.0;  ///< c at the fit; 1 where it is not free
};

/// Maximum likelihood estimate of x in the variance c ratio(u, x), where ratio(u, 0) = 1. c is profiled out unless
/// `scale_known`. `unit` is a typical size of x, from which the search starts.
[[nodiscard]] ModulationFit fit_modulation(const Modulation& levels, bool scale_known, double unit,
                                           const std::function<double(double u, double x)>& ratio);

/// The interval of a contrast between recordings, widened by the root of FullRate::repeatability.
[[nodiscard]] Interval widened(const ModulationFit& fit, const FullRate& data);

}  // namespace driftlab::investigate
