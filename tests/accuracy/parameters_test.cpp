// Coverage of the 95 % intervals of fitted parameters; every repetition counts, a parameter not identified as an
// interval from nothing to its upper limit.
#include "core/fit/candidate_set.hpp"
#include "core/fit/fit_report.hpp"
#include "tests/accuracy/curve.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;

struct Case {
  const char* name;
  Model model;
};

std::vector<Case> cases() {
  return {
      {"WN", model_of({{"white_noise", {0.1}}})},
      {"WN+GM", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 2.0}}})},
      {"WN+GM+RW", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 2.0}}, {"random_walk", {0.1}}})},
      {"WN+GM+DR", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 2.0}}, {"linear_drift", {0.02}}})},
      {"QN+WN+RW", model_of({{"quantization_noise", {0.005}}, {"white_noise", {0.05}}, {"random_walk", {0.05}}})},
      {"WN+2GM", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 5.0}}, {"gauss_markov", {0.3, 0.05}}})},
  };
}

struct Tally {
  std::size_t profile = 0;
  std::size_t preview = 0;
  std::size_t unidentified = 0;
};

void count(Candidate& candidate, const Model& truth, std::vector<Tally>& tally) {
  const auto profile = report_processes(candidate, 1.0, IntervalMethod::Profile, kRise95);
  const auto preview = report_processes(candidate, 1.0, IntervalMethod::Preview, kRise95);
  std::size_t k = 0;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    for (std::size_t i = 0; i < truth[p].parameters.size(); ++i, ++k) {
      const auto inside = [&](const std::vector<FittedProcess>& processes) {
        const FittedParameter& parameter = processes[p].parameters[i];
        return parameter.estimate ? parameter.estimate->ci95.contains(truth[p].parameters[i])
                                  : truth[p].parameters[i] <= parameter.upper_limit;
      };
      tally[k].profile += inside(profile) ? 1 : 0;
      tally[k].preview += preview[p].parameters[i].estimate && inside(preview) ? 1 : 0;
      tally[k].unidentified += profile[p].parameters[i].estimate ? 0 : 1;
    }
  }
}

}  // namespace

TEST(Accuracy, ParameterIntervalsCoverTheTruth) {
  Section section("parameters");
  section.print(
      "\n## Intervals of fitted parameters\n\nCoverage [%%] of nominal 95 %%: profile of the squared distance / "
      "sandwich preview (a miss where it gives none); in brackets how often [%%] the profile says \"not "
      "identifiable\". `J` is the share of J-tests below 0.05.\n\n| truth | N | repetitions | parameters | J |\n"
      "|---|---|---|---|---|\n");
  for (const auto& [samples, full] : {std::pair<std::size_t, std::size_t>{9000, 4000}, {90000, 2000}, {1000000, 400}}) {
    const std::size_t runs = repetitions(full);
    const HaarVariance grid = haar_variance(std::vector<double>(samples, 0.0), 0.0);
    HaarCovariance plan(grid.half, samples, kDt);
    for (const Case& one : cases()) {
      const ModelStructure structure = *parse_model(one.name);
      std::vector<Tally> tally(structure.parameter_count());
      std::size_t rejected = 0;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(2000 + samples, run);
        const std::vector<double> x = simulate(one.model, random, kDt, samples);
        const SimulatedCurve curve = curve_of(x, plan);
        Candidate candidate = fit_alone(curve.moments, structure, curve.sd, curve.logarithms);
        const ModelFit fit = report_fit(candidate, 1.0, static_cast<double>(samples), IntervalMethod::Preview);
        rejected += fit.j_test && fit.j_test->p < 0.05 ? 1 : 0;
        count(candidate, one.model, tally);
      }
      section.print("| %s | %zu | %zu | ", one.name, samples, runs);
      std::size_t k = 0;
      const double percent = 100.0 / static_cast<double>(runs);
      for (const Process& process : one.model) {
        for (const ParameterSpec& spec : process.kind->parameters) {
          EXPECT_GT(percent * static_cast<double>(tally[k].profile),
                    93.0 - 300.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(runs)))
              << one.name << " " << spec.name;
          section.print("%s %.1f/%.1f", std::string(spec.name).c_str(), percent * static_cast<double>(tally[k].profile),
                        percent * static_cast<double>(tally[k].preview));
          if (tally[k].unidentified > 0) {
            section.print(" (%.0f)", percent * static_cast<double>(tally[k].unidentified));
          }
          section.print(", ");
          ++k;
        }
      }
      section.print("| %.1f |\n", percent * static_cast<double>(rejected));
    }
  }
}

}  // namespace driftlab::accuracy
