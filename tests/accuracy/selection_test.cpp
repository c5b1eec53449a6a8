// How often the criteria choose the model that made the data (15 min at 100 Hz, phone-like values).
#include "core/fit/candidate_set.hpp"
#include "core/fit/characterise.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/accuracy/curve.hpp"
#include "tests/accuracy/section.hpp"
#include "tests/likelihood/kalman_likelihood.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kSamples = 90000;

/// Seed paper Table 4, iPhone at rest, in deg/s: N, two Gauss-Markov processes; the walk's step variance 5.7e-8
/// (deg/s)^2.
const std::vector<double> kFast{0.0442, 1.7101};
const std::vector<double> kSlow{0.01716, 9.7259e-3};

struct Tally {
  std::size_t truth = 0;
  std::size_t submodel = 0;
  std::size_t larger = 0;
  std::size_t other = 0;
  std::size_t held = 0;
  std::size_t set_size = 0;

  [[nodiscard]] std::size_t runs() const { return truth + submodel + larger + other; }

  void count(const ModelStructure& chosen, const ModelStructure& truth_structure) {
    if (chosen == truth_structure) {
      ++truth;
    } else if (is_nested(chosen, truth_structure)) {
      ++submodel;
    } else if (is_nested(truth_structure, chosen)) {
      ++larger;
    } else {
      ++other;
    }
  }
};

/// Schwarz' criterion of each candidate at the maximum of its exact likelihood, searched from its fit.
std::vector<double> kalman_bic(const std::vector<double>& x, const std::vector<Candidate>& candidates, double unit) {
  std::vector<double> values;
  for (const Candidate& candidate : candidates) {
    Model start = candidate.log_fit->model_at(candidate.log_fit->best());
    for (Process& process : start) {
      process.parameters[0] *= std::sqrt(unit);
    }
    const auto fit = maximise_likelihood(x, start, kDt);
    values.push_back(
        fit ? bayesian_criterion(fit->likelihood.log_likelihood, candidate.structure.parameter_count(), x.size())
            : std::numeric_limits<double>::infinity());
  }
  return values;
}

}  // namespace

TEST(Accuracy, CriterionFindsTheTruth) {
  Section section("selection");
  section.print(
      "\n## Model selection\n\nShare [%%] of runs in which each criterion chooses the truth, a submodel, a larger "
      "model, "
      "another; for the default also how often its set of models holds the truth, and the set's mean size. The last "
      "row "
      "of a truth is the yardstick: the exact likelihood of the series (Kalman filter) with Schwarz' penalty, in the "
      "first runs only, for it takes seconds a run.\n\n"
      "| truth | criterion | runs | truth | submodel | larger | other | set holds truth | set size |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  const HaarVariance grid = haar_variance(std::vector<double>(kSamples, 0.0), 0.0);
  HaarCovariance plan(grid.half, kSamples, kDt);
  const std::size_t runs = repetitions(500);
  std::vector<ModelStructure> structures;
  for (const std::string& name : CharacteriseOptions{}.models) {
    structures.push_back(*parse_model(name));
  }
  std::size_t forgiven = 0;
  for (const char* name : {"WN", "WN+GM", "WN+GM+RW", "WN+2GM", "WN+2GM+RW"}) {
    const ModelStructure truth = *parse_model(name);
    Model model = model_of({{"white_noise", {1.034 / 60.0}}});
    bool slow_next = false;
    for (const ProcessKind* kind : truth.kinds) {
      if (kind->symbol == "GM") {
        model.push_back({kind, slow_next ? kSlow : kFast});
        slow_next = true;
      } else if (kind->symbol == "RW") {
        model.push_back({kind, {std::sqrt(5.7e-8 / kDt)}});
      }
    }
    const std::vector<std::string> criteria{"distance + p ln N (default)", "distance + 2p", "equation 8, diagonal W",
                                            "Kalman BIC (yardstick)"};
    const std::size_t yardstick_runs = std::min(runs, repetitions(20));
    std::vector<Tally> tally(criteria.size());
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(3000, run);
      const std::vector<double> x = simulate(model, random, kDt, kSamples);
      const HaarVariance raw = haar_variance(x, summarise(x)->mean);
      const double unit = *std::max_element(raw.variance.begin(), raw.variance.end());
      const SimulatedCurve curve = curve_of(x, plan, unit);
      CandidateSet set = *fit_candidates(curve.moments, structures, curve.sd, curve.logarithms);
      forgiven += forgive(curve.moments, set) && set.curve->delta > 0.0 ? 1 : 0;
      measure_by_own(curve.moments, set, [&](const Model& fit) { return curve.fitted.covariance(plan, fit); });
      const std::vector<Candidate>& candidates = set.candidates;
      std::vector<std::vector<double>> value(criteria.size());
      for (const Candidate& candidate : candidates) {
        const auto p = static_cast<double>(candidate.structure.parameter_count());
        value[0].push_back(candidate.criterion(static_cast<double>(kSamples)));
        value[1].push_back(candidate.ranked_distance() + 2.0 * p);
        value[2].push_back(equation_8(curve.moments, candidate.diagonal, curve.sd, curve.covariance).value() +
                           1e-6 * p);
      }
      if (run < yardstick_runs) {
        value[3] = kalman_bic(x, candidates, unit);
      }
      const double lightest = *std::min_element(value[1].begin(), value[1].end());
      for (std::size_t c = 0; c < criteria.size() && !value[c].empty(); ++c) {
        const auto best = std::min_element(value[c].begin(), value[c].end()) - value[c].begin();
        tally[c].count(candidates[static_cast<std::size_t>(best)].structure, truth);
      }
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const bool plausible = value[1][i] <= lightest + 6.0;
        tally[0].set_size += plausible ? 1 : 0;
        tally[0].held += plausible && candidates[i].structure == truth ? 1 : 0;
      }
    }
    const double percent = 100.0 / static_cast<double>(runs);
    const std::map<std::string, double> promised{{"WN", 99.0}, {"WN+GM", 98.0}, {"WN+GM+RW", 83.0}};
    const double slack = 300.0 * std::sqrt(0.05 / static_cast<double>(runs));
    if (promised.contains(name)) {
      EXPECT_GT(percent * static_cast<double>(tally[0].truth), promised.at(name) - slack);
    }
    EXPECT_GT(percent * static_cast<double>(tally[0].held), 95.0 - slack) << name;
    for (std::size_t c = 0; c < criteria.size(); ++c) {
      const Tally& t = tally[c];
      const double share = 100.0 / static_cast<double>(t.runs());
      section.print("| %s | %s | %zu | %.1f | %.1f | %.1f | %.1f |", name, criteria[c].c_str(), t.runs(),
                    share * static_cast<double>(t.truth), share * static_cast<double>(t.submodel),
                    share * static_cast<double>(t.larger), share * static_cast<double>(t.other));
      if (c == 0) {
        section.print(" %.1f | %.1f |\n", percent * static_cast<double>(t.held),
                      static_cast<double>(t.set_size) / static_cast<double>(runs));
      } else {
        section.print(" | |\n");
      }
    }
  }
  // A truth of the list is rejected by chance in 1 % of the runs.
  EXPECT_LT(static_cast<double>(forgiven),
            5.0 * static_cast<double>(runs) * (0.02 + 3.0 * std::sqrt(0.02 / (5.0 * static_cast<double>(runs)))));
  section.print("\nA discrepancy was found in %zu of %zu runs.\n", forgiven, 5 * runs);
}

}  // namespace driftlab::accuracy
