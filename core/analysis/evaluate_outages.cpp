#include "core/analysis/evaluate_outages.hpp"

#include "core/analysis/outage_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {

Result<OutageReport> report_outages(const OutageScenario& scenario, const OutageOptions& options,
                                    const RunControl& control) {
  auto evaluation = evaluate_outages(scenario, options, control);
  if (!evaluation) {
    return fail(evaluation.error());
  }
  return report_of(scenario, std::move(*evaluation));
}

OutageReport report_of(const OutageScenario& scenario, OutageEvaluation evaluation) {
  OutageReport report{scenario, std::move(evaluation), std::nullopt, {}, {}};
  report.attribution = attribute(report.evaluation);
  report.claims = judge_claims(report.evaluation);
  report.summary = verdict_of(report.evaluation, report.attribution, report.claims);
  return report;
}

ErrorEllipse error_ellipse(const PlaneCovariance& covariance, double fraction) {
  const double mean = 0.5 * (covariance.north + covariance.east);
  const double half = 0.5 * (covariance.north - covariance.east);
  const double root = std::hypot(half, covariance.north_east);
  const double radius = std::sqrt(-2.0 * std::log(1.0 - fraction));
  return {fraction, radius * std::sqrt(mean + root), radius * std::sqrt(std::max(mean - root, 0.0)),
          0.5 * std::atan2(covariance.north_east, half)};
}

std::array<ErrorEllipse, 2> error_ellipses(const PlaneCovariance& covariance) {
  return {error_ellipse(covariance, 0.5), error_ellipse(covariance, 0.95)};
}

}  // namespace driftlab
