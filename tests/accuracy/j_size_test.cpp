// The size of the J test where the last scale has a single coefficient, and where it has many.
#include "core/fit/candidate_set.hpp"
#include "core/fit/j_test.hpp"
#include "core/process/distributions.hpp"
#include "tests/accuracy/curve.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

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
      {"WN+RW", model_of({{"white_noise", {0.1}}, {"random_walk", {0.1}}})},
      {"WN+GM", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 2.0}}})},
      {"WN+GM+RW", model_of({{"white_noise", {0.1}}, {"gauss_markov", {0.5, 2.0}}, {"random_walk", {0.1}}})},
  };
}

}  // namespace

TEST(Accuracy, JTestKeepsItsSizeWhereTheLastScaleHasOneCoefficient) {
  Section section("j_size");
  const std::size_t runs = repetitions(2000);
  section.print(
      "\n## Size of the J test\n\nShare [%%] of true models that the J test rejects at a nominal 5 %% and 1 %%, and "
      "the "
      "same at 5 %% if a last scale of a single coefficient took part. Seeds 7000 + N; %zu repetitions: standard error "
      "%.1f points.\n\n| N | truth | 5 %% | 1 %% | with the single coefficient |\n|---|---|---|---|---|\n",
      runs, 100.0 * std::sqrt(0.05 * 0.95 / static_cast<double>(runs)));
  double sum = 0.0;
  std::size_t rows = 0;
  for (const std::size_t samples :
       {std::size_t{1} << 10U, std::size_t{1} << 13U, std::size_t{1} << 16U, std::size_t{9000}, std::size_t{90000}}) {
    const HaarVariance grid = haar_variance(std::vector<double>(samples, 0.0), 0.0);
    HaarCovariance plan(grid.half, samples, kDt);
    const bool octave = (samples & (samples - 1)) == 0;
    for (const Case& one : cases()) {
      std::size_t at_five = 0;
      std::size_t at_one = 0;
      std::size_t whole = 0;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(7000 + samples, run);
        const SimulatedCurve curve = curve_of(simulate(one.model, random, kDt, samples), plan);
        const Candidate candidate =
            fit_candidate(curve.moments, *parse_model(one.name), curve.sd,
                          std::make_shared<const WhitenedCurve>(whitened(curve.logarithms, 0.0)));
        const double p = j_test(candidate)->p;
        at_five += p < 0.05 ? 1 : 0;
        at_one += p < 0.01 ? 1 : 0;
        constexpr double kShort = 1.15;  // what the longest scales scatter too little (core/fit/j_test.cpp)
        const double dof = static_cast<double>(candidate.log_fit->scales()) - static_cast<double>(candidate.parameters);
        whole += chi_squared_tail(candidate.log_fit->minimum(), dof - kShort) < 0.05 ? 1 : 0;
      }
      const double percent = 100.0 / static_cast<double>(runs);
      const double size = percent * static_cast<double>(at_five);
      EXPECT_NEAR(size, 5.0, 1.0 + 300.0 * std::sqrt(0.05 * 0.95 / static_cast<double>(runs)))
          << one.name << " " << samples;
      sum += size;
      ++rows;
      section.print("| %zu | %s | %.1f | %.1f |", samples, one.name, size, percent * static_cast<double>(at_one));
      if (octave) {
        section.print(" %.1f |\n", percent * static_cast<double>(whole));
      } else {
        section.print(" |\n");
      }
    }
  }
  EXPECT_NEAR(sum / static_cast<double>(rows), 5.0, 1.0) << "on average over the table";
}

}  // namespace driftlab::accuracy
