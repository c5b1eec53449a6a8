#pragma once
/// What an error model implies of the curves that are drawn beside the measured ones: its Allan deviation and its
/// two-sided density, as a whole and process by process.
///
/// The laws are those of the fit (core/process/process.hpp), so that a page holds no second copy of them. Processes are
/// independent: variances and densities add.
#include "core/process/model.hpp"
#include "core/signal/unit.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

struct ImpliedComponent {
  std::string process;                         ///< registry name
  std::vector<double> deviation;               ///< Allan deviation at each tau [channel unit]
  std::vector<std::optional<double>> density;  ///< at each frequency [unit^2/Hz]; nothing where the process has none
};

struct ImpliedCurves {
  std::vector<double> tau_s;
  std::vector<double> deviation;  ///< of the whole model
  std::vector<double> f_hz;
  std::vector<std::optional<double>> density;  ///< nothing where a process has none
  std::vector<ImpliedComponent> components;    ///< one per process
};

/// At tau = m dt for every m of `halves` (whole numbers from 1) and at every frequency of `f_hz`, 0 < f <= 1/(2 dt).
[[nodiscard]] ImpliedCurves implied_curves(const Model& model, double dt_s, std::span<const double> halves,
                                           std::span<const double> f_hz);

/// An Allan deviation as it was measured, with the ends of its intervals; what is not known is empty. Lists of one
/// length.
struct MeasuredDeviation {
  std::vector<double> tau_s;                     ///< whole multiples of dt
  std::vector<std::optional<double>> deviation;  ///< [channel unit]
  std::vector<std::optional<double>> low;
  std::vector<std::optional<double>> high;
};

/// Ratio of the measured deviation to that of the model, at the measured averaging times.
struct MeasuredOverModel {
  std::vector<double> tau_s;
  std::vector<double> deviation;             ///< implied [channel unit]
  std::vector<std::optional<double>> ratio;  ///< measured over implied; empty where either is not there
  std::vector<std::optional<double>> low;    ///< lower end of the measured interval over the implied deviation
  std::vector<std::optional<double>> high;
};

/// The curves of a fit and its ratio to the measured curve, in the channel's own unit.
struct ImpliedBeside {
  /// Averaging times at eight to the octave, up to 1.25 times the longest measured one, tau_max; and 160 frequencies,
  /// evenly spaced in the logarithm, from 1/(2 tau_max) to 1/(2 dt).
  ImpliedCurves curves;
  MeasuredOverModel at_measured;
};

/// `model` is SI, the result is in `unit`, that of `measured`, which has at least one time. O(times x processes).
[[nodiscard]] ImpliedBeside implied_beside(const Model& model, const Unit& unit, double dt_s,
                                           const MeasuredDeviation& measured);

/// Whole numbers from 1 to `largest`, about `per_octave` of them to the octave.
[[nodiscard]] std::vector<double> octave_grid(double largest, int per_octave);

}  // namespace driftlab
