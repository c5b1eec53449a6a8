#include "core/fit/allan_regression.hpp"

#include "core/fit/fit_report.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {

AllanParameters allan_regression(const WaveletMoments& moments, const Eigen::VectorXd& sd, CurveCovariance curve,
                                 double unit) {
  AllanParameters result;
  // Fewer scales than terms: the steep ones go first, they need long records.
  const std::vector<std::string_view> names{"WN", "WN+RW", "QN+WN+RW", "QN+WN+FN+RW", "QN+WN+FN+RW+DR"};
  const auto choice = std::min<std::size_t>(names.size(), static_cast<std::size_t>(moments.nu.size()));
  const std::string few = "The record is too short: fewer scales than terms.";
  result.q_reason = result.n_reason = result.b_reason = result.k_reason = result.r_reason = few;
  if (choice == 0) {
    return result;
  }
  const Result<ModelStructure> structure = parse_model(names[choice - 1]);
  Candidate candidate = fit_alone(moments, *structure, sd, std::move(curve));
  if (!candidate.log_fit) {
    return result;
  }
  const auto store = [&](const FittedParameter& parameter, std::optional<Estimate>& estimate, std::string& reason) {
    estimate = parameter.estimate;
    reason = parameter.reason;
  };
  for (const FittedProcess& process : report_processes(candidate, unit, IntervalMethod::Profile, kRise95)) {
    const FittedParameter& level = process.parameters.front();
    if (level.name == "Q") {
      store(level, result.q, result.q_reason);
    } else if (level.name == "N") {
      store(level, result.n, result.n_reason);
    } else if (level.name == "B") {
      store(level, result.b, result.b_reason);
    } else if (level.name == "K") {
      store(level, result.k, result.k_reason);
    } else {
      store(level, result.r, result.r_reason);
    }
  }
  return result;
}

}  // namespace driftlab
