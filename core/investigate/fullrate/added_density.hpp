#pragma once
/// One more density in some recordings, against what the others show.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/signal/estimate.hpp"

namespace driftlab::investigate {

struct AddedDensity {
  double level = 0.0;
  Interval interval;
  double gain = 0.0;  ///< twice the log likelihood gained
};

/// Level of `shape(f, dt)` in the recordings of the scope. Where white + slow describes the spectra (data.flat),
/// against that, N^2 free with an automatic baseline; else against a spectrum that is free in every bin and common to
/// all recordings of the same length, which needs one of these outside the scope.
[[nodiscard]] AddedDensity fit_added_density(const FullRate& data, const std::vector<std::size_t>& scope,
                                             double (*shape)(double f_hz, double dt_s));

/// Log likelihood that a level found elsewhere gains here.
[[nodiscard]] double added_density_gain(const FullRate& data, const std::vector<std::size_t>& scope,
                                        double (*shape)(double f_hz, double dt_s), double level);

}  // namespace driftlab::investigate
