#pragma once
/// Conversion of a fitted candidate into a ModelFit: parameters in SI with intervals, or the reason why there is none.
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"

namespace driftlab {

enum class IntervalMethod {
  Preview,  ///< curvature of the quasi-likelihood (sandwich) on the logarithms: fast, too short near a bound
  Profile,  ///< profile of the quasi-likelihood: holds its promise, open where the data give no limit
};

/// Parameters of a candidate's processes in canonical order. `unit` is the number of SI units in one unit of the
/// candidate's moments. `rise` is how far L may exceed its minimum inside a 95 % interval: 3.84. Where the model's own
/// discrepancy exceeds that of the candidates, the interval is widened as its sandwich is.
[[nodiscard]] std::vector<FittedProcess> report_processes(Candidate& candidate, double unit, IntervalMethod method,
                                                          double rise);

/// The same with a rise for each coordinate of the candidate's LogFit, as a bootstrap gives them.
[[nodiscard]] std::vector<FittedProcess> report_processes(Candidate& candidate, double unit,
                                                          const std::vector<double>& rises);

/// The complete ModelFit. `samples` is the N of the criterion. `rises` are those of a bootstrap, empty without one.
[[nodiscard]] ModelFit report_fit(Candidate& candidate, double unit, double samples, IntervalMethod method,
                                  const std::vector<double>& rises = {});

/// The rise of the squared distance L that bounds the 95 % interval of one parameter: chi-square(1) at 0.95.
inline constexpr double kRise95 = 3.841458820694124;

}  // namespace driftlab
