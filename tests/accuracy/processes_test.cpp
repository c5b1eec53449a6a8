// Coverage of the 95 % intervals where the fast part is filtered or resonates and the slow part is a power law, the
// structure given.
#include "core/fit/candidate_set.hpp"
#include "core/fit/fit_report.hpp"
#include "tests/accuracy/curve.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kSamples = 90000;

struct Case {
  const char* name;
  Model model;
};

std::vector<Case> cases() {
  return {
      {"RW+LP2", model_of({{"random_walk", {0.02}}, {"low_pass_2", {0.1, 20.0}}})},
      {"RW+MA", model_of({{"random_walk", {0.02}}, {"moving_average", {0.1, 3.25}}})},
      {"RW+DEC", model_of({{"random_walk", {0.02}}, {"decimation", {0.1, 2.0}}})},
      {"WN+PL", model_of({{"white_noise", {0.1}}, {"power_law", {0.1, 1.3}}})},
      {"WN+RW+RES", model_of({{"white_noise", {0.1}}, {"random_walk", {0.02}}, {"resonance", {0.5, 20.0, 12.0}}})},
  };
}

struct Tally {
  std::size_t covered = 0;
  std::size_t unidentified = 0;
  double log_sum = 0.0;
  double log_squares = 0.0;
};

}  // namespace

TEST(Accuracy, IntervalsOfFilteredAndResonantNoiseCoverTheTruth) {
  Section section("processes");
  section.print(
      "\n## Band-limited noise, resonances and power laws\n\nN = %zu at 100 Hz, octave scales, the structure given. "
      "Per "
      "parameter: coverage [%%] of nominal 95 %% profile intervals, mean and standard deviation of the logarithm of "
      "estimate/truth [%%]; in brackets how often [%%] it is \"not identifiable\". `J` is the share of J-tests below "
      "0.05.\n\n| truth | repetitions | parameters | J |\n|---|---|---|---|\n",
      kSamples);
  const HaarVariance grid = haar_variance(std::vector<double>(kSamples, 0.0), 0.0);
  HaarCovariance plan(grid.half, kSamples, kDt);
  const std::size_t runs = repetitions(400);
  for (const Case& one : cases()) {
    const ModelStructure structure = *parse_model(one.name);
    std::vector<Tally> tally(structure.parameter_count());
    std::size_t rejected = 0;
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(2015, run);
      const std::vector<double> x = simulate(one.model, random, kDt, kSamples);
      const SimulatedCurve curve = curve_of(x, plan);
      Candidate candidate = fit_alone(curve.moments, structure, curve.sd, curve.logarithms);
      const ModelFit fit = report_fit(candidate, 1.0, static_cast<double>(kSamples), IntervalMethod::Profile);
      rejected += fit.j_test && fit.j_test->p < 0.05 ? 1 : 0;
      std::size_t k = 0;
      for (std::size_t p = 0; p < one.model.size(); ++p) {
        for (std::size_t i = 0; i < one.model[p].parameters.size(); ++i, ++k) {
          const FittedParameter& parameter = fit.processes[p].parameters[i];
          const double truth = one.model[p].parameters[i];
          tally[k].unidentified += parameter.estimate ? 0 : 1;
          tally[k].covered +=
              parameter.estimate ? parameter.estimate->ci95.contains(truth) : truth <= parameter.upper_limit;
          if (parameter.estimate) {
            const double error = 100.0 * std::log(parameter.estimate->value / truth);
            tally[k].log_sum += error;
            tally[k].log_squares += error * error;
          }
        }
      }
    }
    section.print("| %s | %zu | ", one.name, runs);
    const double percent = 100.0 / static_cast<double>(runs);
    std::size_t k = 0;
    for (const Process& process : one.model) {
      for (const ParameterSpec& spec : process.kind->parameters) {
        const Tally& one_tally = tally[k++];
        const auto known = static_cast<double>(runs - one_tally.unidentified);
        const double mean = one_tally.log_sum / known;
        const double sd = std::sqrt(std::max(0.0, one_tally.log_squares / known - mean * mean));
        EXPECT_GT(percent * static_cast<double>(one_tally.covered),
                  93.0 - 300.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(runs)))
            << one.name << " " << spec.name;
        section.print("%s %.1f, %.2f +- %.2f", std::string(spec.name).c_str(),
                      percent * static_cast<double>(one_tally.covered), mean, sd);
        if (one_tally.unidentified > 0) {
          section.print(" (%.0f)", percent * static_cast<double>(one_tally.unidentified));
        }
        section.print("; ");
      }
    }
    section.print("| %.1f |\n", percent * static_cast<double>(rejected));
  }
}

}  // namespace driftlab::accuracy
