#include "core/fit/further_curves.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// Nothing of a record that is too short for the curve.
std::optional<LongTauCurve> in_si(LongTauCurve curve, double square) {
  if (curve.tau_s.empty()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < curve.tau_s.size(); ++i) {
    curve.variance[i] *= square;
    curve.ci95[i] = {curve.ci95[i].low * square, curve.ci95[i].high * square};
  }
  return curve;
}

}  // namespace

FurtherCurves further_curves(const FurtherRequest& request, std::span<const double> samples, double mean,
                             double unit_square, double si_factor, const Model& mixture, double dt_s,
                             const RunControl& control) {
  FurtherCurves curves;
  const double square = unit_square * si_factor * si_factor;
  if (request.total && !control.stop.stop_requested()) {
    curves.total = in_si(total_curve(samples, mean, unit_square, mixture, dt_s), square);
  }
  if (request.theo1 && !control.stop.stop_requested()) {
    curves.theo1 = in_si(theo1_curve(samples, mean, unit_square, mixture, dt_s), square);
  }
  if (request.psd) {
    PowerSpectrum spectrum = power_spectrum(samples, mean, dt_s, control);
    for (std::size_t i = 0; i < spectrum.density.size(); ++i) {
      const Interval interval = spectrum.ci95[i];
      spectrum.density[i] *= si_factor * si_factor;
      spectrum.ci95[i] = {interval.low * si_factor * si_factor, interval.high * si_factor * si_factor};
    }
    for (SpectrumLine& line : spectrum.lines) {
      line.amplitude *= std::fabs(si_factor);
    }
    if (!spectrum.density.empty()) {
      curves.psd = std::move(spectrum);
    }
  }
  return curves;
}

}  // namespace driftlab
