#include "core/campaign/regression/verdict.hpp"

#include <algorithm>

namespace driftlab::regression {
namespace {

bool fails(const Outcome& outcome, double theta, double margin, const TestSettings& settings) {
  const bool worse = settings.fail_on_worse && outcome.lower > 0.0 && theta > margin;
  const bool better = settings.two_sided && outcome.upper < -margin;
  return outcome.lower > margin || worse || better;
}

Finding finding_of(const Outcome& outcome, double theta, double margin, const TestSettings& settings) {
  if (fails(outcome, theta, margin, settings)) {
    return Finding::Beyond;
  }
  if (outcome.upper < 0.0) {
    return Finding::Improved;
  }
  if (outcome.upper_one < margin) {
    return outcome.lower > 0.0 ? Finding::WorseWithinMargin : Finding::Ok;
  }
  return Finding::Open;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Pass:
      return "pass";
    case Verdict::Fail:
      return "fail";
    case Verdict::Inconclusive:
      break;
  }
  return "inconclusive";
}

std::string_view name_of(Finding finding) {
  switch (finding) {
    case Finding::Ok:
      return "ok";
    case Finding::WorseWithinMargin:
      return "worse_within_margin";
    case Finding::Beyond:
      return "beyond";
    case Finding::Improved:
      return "improved";
    case Finding::Open:
      break;
  }
  return "open";
}

Comparison compare(const Design& design, const TestSettings& settings, const std::stop_token& stop) {
  Comparison comparison;
  const ScatterTerms terms = scatter_terms(design);
  comparison.scatter = learn_scatter(design, terms, settings.prior_df, stop);
  if (stop.stop_requested()) {
    return comparison;
  }
  comparison.contrast = make_contrast(design, terms, comparison.scatter);
  const Contrast& contrast = comparison.contrast;
  const Critical critical = critical_values(contrast, comparison.scatter, settings);
  comparison.c_max = critical.c_max;
  comparison.c_1 = critical.c_1;
  comparison.gate = choose_gate(design, contrast, critical, settings);
  const Eigen::VectorXd largest =
      critical.draws.size() > 0 ? Eigen::VectorXd(critical.draws.colwise().maxCoeff()) : Eigen::VectorXd();
  bool fail = false;
  bool pass =
      std::find(comparison.gate.gated.begin(), comparison.gate.gated.end(), true) != comparison.gate.gated.end();
  for (std::size_t t = 0; t < contrast.tests.size(); ++t) {
    const auto i = static_cast<Eigen::Index>(t);
    const double theta = contrast.theta(i);
    const double se = contrast.se(i);
    const double margin = contrast.tests[t].margin;
    Outcome outcome;
    outcome.lower = theta - critical.c_max * se;
    outcome.upper = theta + critical.c_max * se;
    outcome.upper_one = theta + critical.c_1 * se;
    outcome.p_adjusted =
        static_cast<double>((largest.array() >= (theta - margin) / se).count()) / static_cast<double>(largest.size());
    outcome.finding = finding_of(outcome, theta, margin, settings);
    fail = fail || outcome.finding == Finding::Beyond;
    pass = pass && (!comparison.gate.gated[t] || outcome.upper_one < margin);
    comparison.worse_shown = comparison.worse_shown || outcome.lower > 0.0;
    comparison.outcomes.push_back(outcome);
  }
  comparison.verdict = fail ? Verdict::Fail : pass ? Verdict::Pass : Verdict::Inconclusive;
  if (comparison.verdict == Verdict::Inconclusive) {
    comparison.needs = what_would_decide(design, contrast, comparison.scatter, comparison.gate, settings, stop);
  }
  return comparison;
}

}  // namespace driftlab::regression
