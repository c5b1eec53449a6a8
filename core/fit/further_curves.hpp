#pragma once
/// What a channel's characterisation holds beside its Allan and wavelet variances, on request: total variance, Theo1
/// (core/variance/long_tau.hpp) and the power spectral density with its lines (core/variance/power_spectrum.hpp).
#include "core/signal/progress.hpp"
#include "core/variance/long_tau.hpp"
#include "core/variance/power_spectrum.hpp"

#include <optional>
#include <span>

namespace driftlab {

struct FurtherRequest {
  bool total = false;
  bool theo1 = false;
  bool psd = false;

  [[nodiscard]] bool any() const { return total || theo1 || psd; }
};

/// SI like the rest of a characterisation; empty where not asked for, and where the record is too short.
struct FurtherCurves {
  std::optional<LongTauCurve> total;
  std::optional<LongTauCurve> theo1;
  std::optional<PowerSpectrum> psd;
};

/// `samples` without gaps in their own unit, `mixture` fitted to their curve in units of `unit_square` [sample unit^2],
/// `si_factor` sample unit -> SI.
[[nodiscard]] FurtherCurves further_curves(const FurtherRequest& request, std::span<const double> samples, double mean,
                                           double unit_square, double si_factor, const Model& mixture, double dt_s,
                                           const RunControl& control = {});

}  // namespace driftlab
