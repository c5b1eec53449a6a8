#pragma once
/// An additional spectral density in some recordings, estimated relative to the others.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/signal/estimate.hpp"

namespace driftlab::investigate {

struct AddedDensity {
  double level = 0.0;
  Interval interval;
  double gain = 0.0;  ///< twice the log likelihood gained
};

/// Level of the density `shape(f, dt)` in the recordings of the scope. If white noise and the slow part describe the
/// spectra (data.flat), the comparison is with these, and N^2 is free under an automatic baseline. Otherwise it is with
/// a spectrum that is free in every bin and common to all recordings of the same length; at least one of these must be
/// outside the scope.
[[nodiscard]] AddedDensity fit_added_density(const FullRate& data, const std::vector<std::size_t>& scope,
                                             double (*shape)(double f_hz, double dt_s));

/// Log likelihood that a level found elsewhere gains here.
[[nodiscard]] double added_density_gain(const FullRate& data, const std::vector<std::size_t>& scope,
                                        double (*shape)(double f_hz, double dt_s), double level);

}  // namespace driftlab::investigate
