#pragma once
/// Optional curves of a channel's characterisation, beside its Allan and wavelet variances at octaves: the Allan
/// variance at more averaging times, total variance and Theo1 (core/variance/long_tau.hpp), and the power spectral
/// density with its lines (core/variance/power_spectrum.hpp).
#include "core/signal/progress.hpp"
#include "core/variance/long_tau.hpp"
#include "core/variance/power_spectrum.hpp"
#include "core/variance/variance_intervals.hpp"

#include <optional>
#include <span>

namespace driftlab {

struct FurtherRequest {
  bool total = false;
  bool theo1 = false;
  bool psd = false;
  std::size_t taus = 0;  ///< averaging times of a finer Allan curve, kFewestTaus to kMostTaus; 0: none
};

constexpr std::size_t kFewestTaus = 2;
constexpr std::size_t kMostTaus = 500;

/// SI like the rest of a characterisation; empty where not asked for, and where the record is too short.
struct FurtherCurves {
  std::optional<LongTauCurve> total;
  std::optional<LongTauCurve> theo1;
  std::optional<PowerSpectrum> psd;
  /// Overlapping Allan variance at about `taus` averaging times, evenly spaced in the logarithm from dt to half of the
  /// record. Short records hold fewer whole multiples of dt.
  std::optional<LongTauCurve> allan;
};

/// The curve of the record at octaves, from which the finer Allan curve derives its degrees of freedom.
struct OctaveCurve {
  const VarianceIntervals& intervals;  ///< in units of `unit_square`
  HaarCovariance& plan;
};

/// `samples` without gaps in their own unit, `octaves` their curve in units of `unit_square` [sample unit^2],
/// `si_factor` sample unit -> SI. The estimation variance at each finer tau is the one that the mixture of `octaves`
/// implies, times a ratio interpolated in ln tau: at each octave, the estimation variance stated in `octaves.intervals`
/// over the one that the mixture implies. The ratio carries lost samples, heavy tails and scatter seen in the record.
[[nodiscard]] FurtherCurves further_curves(const FurtherRequest& request, std::span<const double> samples, double mean,
                                           double unit_square, double si_factor, const OctaveCurve& octaves,
                                           const RunControl& control = {});

}  // namespace driftlab
