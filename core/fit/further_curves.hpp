#pragma once
/// What a channel's characterisation holds beside its Allan and wavelet variances, on request: the Allan variance at
/// more averaging times than its octaves, total variance, Theo1 (core/variance/long_tau.hpp) and the power spectral
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

/// The octave curve of the record: where the finer one takes its scatter from.
struct OctaveCurve {
  const VarianceIntervals& intervals;  ///< in units of `unit_square`
  HaarCovariance& plan;
};

/// `samples` without gaps in their own unit, `octaves` their curve in units of `unit_square` [sample unit^2],
/// `si_factor` sample unit -> SI. The variance of a finer Allan variance is that of the mixture of `octaves`, times
/// what the octaves' own variances are of theirs (lost samples, heavy tails, scatter seen in the record), interpolated
/// in ln tau.
[[nodiscard]] FurtherCurves further_curves(const FurtherRequest& request, std::span<const double> samples, double mean,
                                           double unit_square, double si_factor, const OctaveCurve& octaves,
                                           const RunControl& control = {});

}  // namespace driftlab
