#include "core/fit/bootstrap.hpp"

#include "core/variance/haar_variance.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace driftlab {

Error replicates_error(std::size_t replicates) {
  static_assert(kFewestReplicates == 40 && kMostReplicates == 2000, "the sentence says so");
  Error error{ErrorCode::InvalidArgument, "A bootstrap takes between 40 and 2000 replicates.", {}};
  error.fields.push_back({"parameter", "bootstrap"});
  error.fields.push_back({"value", std::to_string(replicates)});
  return error;
}

Result<std::vector<double>> bootstrap_rises(const Candidate& candidate, const WaveletMoments& moments,
                                            std::size_t replicates, std::uint64_t seed, const RunControl& control) {
  if (replicates < kFewestReplicates || replicates > kMostReplicates) {
    return fail(replicates_error(replicates));
  }
  if (!candidate.log_fit || !moments.row_dt_s.empty()) {
    return fail(ErrorCode::InvalidArgument, "Only a fit to one recording can be simulated.");
  }
  const LogFit& fitted = *candidate.log_fit;
  const Model truth = fitted.model_at(fitted.best());
  const std::size_t count = fitted.coordinates().size();
  std::vector<std::vector<double>> rises(count);
  for (std::size_t r = 0; r < replicates; ++r) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The bootstrap was cancelled.");
    }
    control.report("bootstrap", static_cast<double>(r) / static_cast<double>(replicates));
    Random random(seed, r);
    const std::vector<double> path = simulate(truth, random, moments.dt_s, static_cast<std::size_t>(moments.samples));
    const HaarVariance curve = haar_variance(path, path.front());
    WaveletMoments drawn = moments;
    drawn.nu = Eigen::Map<const Eigen::VectorXd>(curve.variance.data(), static_cast<Eigen::Index>(curve.scales()));
    CurveCovariance redrawn = fitted.curve().curve;
    for (Eigen::Index j = 0; j < redrawn.rows(); ++j) {
      const Eigen::Index row = redrawn.used[static_cast<std::size_t>(j)];
      const double discrepancy = fitted.curve().delta > 0.0 ? fitted.curve().delta * random.normal() : 0.0;
      redrawn.log_variance(j) = std::log(drawn.nu(row)) - redrawn.bias(j) + discrepancy;
    }
    const auto curve_drawn = std::make_shared<const WhitenedCurve>(whitened(std::move(redrawn), fitted.curve().delta));
    LogFit fit(drawn, truth, curve_drawn);
    for (std::size_t k = 0; k < count; ++k) {
      rises[k].push_back(fit.rise_at(k, fitted.best()(static_cast<Eigen::Index>(k))));
    }
  }
  std::vector<double> quantile;
  const auto rank =
      std::min(replicates, static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(replicates + 1))));
  for (std::vector<double>& values : rises) {
    std::sort(values.begin(), values.end());
    quantile.push_back(values[rank - 1]);
  }
  return quantile;
}

}  // namespace driftlab
