#include "core/campaign/regression/ratios.hpp"

#include <cmath>

namespace driftlab::regression {

RatioReport ratios_of(const ScaleReport& told) {
  return {std::exp(told.theta),
          {std::exp(told.outcome.lower), std::exp(told.outcome.upper)},
          std::exp(told.outcome.upper_one),
          std::exp(told.test.margin)};
}

TrendRatios ratios_of(const ReleaseTrend& trend) {
  return {std::exp(trend.slope), {std::exp(trend.ci95.low), std::exp(trend.ci95.high)}, std::exp(trend.total)};
}

ScatterFactors factors_of(const SessionScatter& scatter) {
  return {{std::sqrt(scatter.mean_square_common()), {scatter.quantile_common(0.025), scatter.quantile_common(0.975)}},
          {std::sqrt(scatter.mean_square_local()), {scatter.quantile_local(0.025), scatter.quantile_local(0.975)}}};
}

}  // namespace driftlab::regression
