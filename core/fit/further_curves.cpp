#include "core/fit/further_curves.hpp"

#include "core/variance/allan_variance.hpp"

#include <algorithm>
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

/// What the estimates' variances at the octaves are of those under the mixture alone, read at any half length.
class ScatterBesideMixture {
 public:
  explicit ScatterBesideMixture(const OctaveCurve& octaves) : half_(octaves.plan.half()) {
    ratio_ = octaves.intervals.estimate_variance.cwiseQuotient(octaves.plan.diagonal(octaves.intervals.mixture));
  }
  [[nodiscard]] double at(double half) const {
    const auto above = std::upper_bound(half_.begin(), half_.end(), half) - half_.begin();
    if (above == 0 || above == ratio_.size()) {
      return ratio_(above == 0 ? 0 : above - 1);
    }
    const auto next = static_cast<std::size_t>(above);
    const double part = std::log(half / half_[next - 1]) / std::log(half_[next] / half_[next - 1]);
    return ratio_(above - 1) * std::pow(ratio_(above) / ratio_(above - 1), part);
  }

 private:
  std::span<const double> half_;
  Eigen::VectorXd ratio_;
};

LongTauCurve finer_allan(std::span<const double> samples, double mean, double unit_square, const OctaveCurve& octaves,
                         std::size_t taus, const RunControl& control) {
  const std::vector<std::size_t> half = log_spaced_half_lengths(samples.size(), taus);
  const std::vector<double> allan = allan_variance(samples, mean, half, control);
  LongTauCurve curve;
  if (allan.empty()) {
    return curve;
  }
  const double dt_s = octaves.plan.dt_s();
  HaarCovariance plan(half, samples.size(), dt_s);
  const Eigen::VectorXd variance = plan.diagonal(octaves.intervals.mixture);
  const ScatterBesideMixture scatter(octaves);
  for (std::size_t k = 0; k < half.size(); ++k) {
    const auto m = static_cast<double>(half[k]);
    const double modelled = haar_variance(octaves.intervals.mixture, m, dt_s);
    const double edf = 2.0 * modelled * modelled / (variance(static_cast<Eigen::Index>(k)) * scatter.at(m));
    curve.tau_s.push_back(m * dt_s);
    curve.variance.push_back(allan[k] / unit_square);
    curve.ci95.push_back(chi_square_interval(curve.variance.back(), edf));
    curve.edf.push_back(edf);
  }
  return curve;
}

}  // namespace

FurtherCurves further_curves(const FurtherRequest& request, std::span<const double> samples, double mean,
                             double unit_square, double si_factor, const OctaveCurve& octaves,
                             const RunControl& control) {
  FurtherCurves curves;
  const double square = unit_square * si_factor * si_factor;
  const Model& mixture = octaves.intervals.mixture;
  const double dt_s = octaves.plan.dt_s();
  if (request.taus > 0 && !control.stop.stop_requested()) {
    curves.allan = in_si(finer_allan(samples, mean, unit_square, octaves, request.taus, control), square);
  }
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
