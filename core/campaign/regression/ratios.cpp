#include "core/campaign/regression/ratios.hpp"

#include "core/process/distributions.hpp"

#include <cmath>

namespace driftlab::regression {

namespace {

Estimate deviation_of(const ArmMean& mean) {
  const auto at = [&](double deviations) { return std::sqrt(2.0) * std::exp(mean.x + deviations * mean.se); };
  return {at(0.0), {at(-kNormal975), at(kNormal975)}};
}

}  // namespace

RatioReport ratios_of(const ScaleReport& told) {
  RatioReport ratios{std::exp(told.theta),
                     {std::exp(told.outcome.lower), std::exp(told.outcome.upper)},
                     std::exp(told.outcome.upper_one),
                     std::exp(told.test.margin)};
  if (told.means) {
    ratios.deviations = {deviation_of((*told.means)[0]), deviation_of((*told.means)[1])};
  }
  return ratios;
}

TrendRatios ratios_of(const ReleaseTrend& trend) {
  return {std::exp(trend.slope), {std::exp(trend.ci95.low), std::exp(trend.ci95.high)}, std::exp(trend.total)};
}

ScatterFactors factors_of(const SessionScatter& scatter) {
  return {{std::sqrt(scatter.mean_square_common()), {scatter.quantile_common(0.025), scatter.quantile_common(0.975)}},
          {std::sqrt(scatter.mean_square_local()), {scatter.quantile_local(0.025), scatter.quantile_local(0.975)}}};
}

}  // namespace driftlab::regression
