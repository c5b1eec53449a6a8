#pragma once
/// The use case "evaluate outages": a scenario in, its filters compared through GNSS outages out, with what the
/// comparison says about the published claims.
#include "core/campaign/verdict.hpp"
#include "core/navigate/outage_claims.hpp"
#include "core/navigate/outage_evaluation.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <array>
#include <optional>
#include <vector>

namespace driftlab {

struct OutageReport {
  OutageScenario scenario;  ///< what was asked for, every model spelled out
  OutageEvaluation evaluation;
  std::optional<Attribution>
      attribution;  ///< nothing where the six filters of the paper's comparison are not all there
  std::vector<Claim> claims;
  Verdict summary;  ///< what it says (core/analysis/outage_verdict.hpp)
};

/// Errors: those of evaluate_outages. Results do not depend on the threads of `control`.
[[nodiscard]] Result<OutageReport> report_outages(const OutageScenario& scenario, const OutageOptions& options = {},
                                                  const RunControl& control = {});

/// What the evaluation of a scenario says.
[[nodiscard]] OutageReport report_of(const OutageScenario& scenario, OutageEvaluation evaluation);

/// The ellipse that holds a fraction of a normal distribution in the plane: half axes [m], direction of the longer one
/// from north over east [rad].
struct ErrorEllipse {
  double fraction = 0.0;
  double semi_major_m = 0.0;
  double semi_minor_m = 0.0;
  double azimuth_rad = 0.0;
};

/// `fraction` in (0, 1). In the plane the squared Mahalanobis distance is chi-square of two degrees of freedom, whose
/// quantile is -2 ln(1 - fraction); the half axes are the roots of the eigenvalues times its root.
[[nodiscard]] ErrorEllipse error_ellipse(const PlaneCovariance& covariance, double fraction);

/// Those that are told and drawn: of 50 and of 95 %.
[[nodiscard]] std::array<ErrorEllipse, 2> error_ellipses(const PlaneCovariance& covariance);

}  // namespace driftlab
