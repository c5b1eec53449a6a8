#pragma once
/// From a candidate to the ModelFit that leaves the estimator: parameters in SI with intervals, or the reason for none.
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"

namespace driftlab {

enum class IntervalMethod {
  Preview,  ///< curvature of the quasi-likelihood (sandwich) on the logarithms: fast, too short near a bound
  Profile,  ///< profile of the quasi-likelihood: holds its promise, open where the data give no limit
};

/// Parameters of a candidate's processes in canonical order. `unit`: SI units in one unit of the candidate's moments.
/// `rise`: how far L may rise inside a 95 % interval (3.84, more where the model is known not to fit).
[[nodiscard]] std::vector<FittedProcess> report_processes(Candidate& candidate, double unit, IntervalMethod method,
                                                          double rise);

/// The same with a rise for each coordinate of the candidate's LogFit, as a bootstrap gives them.
[[nodiscard]] std::vector<FittedProcess> report_processes(Candidate& candidate, double unit,
                                                          const std::vector<double>& rises);

/// The whole fit. `samples`: N of the criterion. `rises`: of a bootstrap, empty without one.
[[nodiscard]] ModelFit report_fit(Candidate& candidate, double unit, double samples, IntervalMethod method,
                                  const std::vector<double>& rises = {});

/// Squared-distance rise of a 95 % interval of one parameter: chi-square(1) at 0.95.
inline constexpr double kRise95 = 3.841458820694124;

}  // namespace driftlab
