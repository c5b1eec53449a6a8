#pragma once
/// What an error model implies of the curves that are drawn beside the measured ones: its Allan deviation and its
/// two-sided density, as a whole and process by process.
///
/// The laws are those of the fit (core/process/process.hpp), so that a page holds no second copy of them. Processes are
/// independent: variances and densities add.
#include "core/process/model.hpp"

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

/// Whole numbers from 1 to `largest`, about `per_octave` of them between each and its double.
[[nodiscard]] std::vector<double> octave_grid(double largest, int per_octave);

}  // namespace driftlab
