// Coverage of the 95 % intervals of the wavelet variance, noise model unknown.
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/variance_intervals.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace driftlab::accuracy {
namespace {

constexpr double kDt = 1.0;

struct Truth {
  const char* name;
  Model model;
  std::function<void(Random&, std::vector<double>&)> simulate;  ///< replaces the model's own simulation
};

std::vector<Truth> truths() {
  std::vector<Truth> all;
  all.push_back({"WN", model_of({{"white_noise", {1.0}}}), {}});
  all.push_back(
      {"QN (Gaussian)", model_of({{"quantization_noise", {1.0}}}), [](Random& random, std::vector<double>& x) {
         double previous = random.normal();
         for (double& value : x) {
           const double next = random.normal();
           value = next - previous;
           previous = next;
         }
       }});
  all.push_back({"GM", model_of({{"gauss_markov", {1.0, 0.05}}}), {}});
  all.push_back({"RW", model_of({{"random_walk", {1.0}}}), {}});
  all.push_back({"flicker", model_of({{"flicker_noise", {1.0}}}), {}});
  all.push_back(
      {"WN+GM+RW", model_of({{"white_noise", {1.0}}, {"gauss_markov", {0.3, 0.02}}, {"random_walk", {0.001}}}), {}});
  all.push_back({"WN, Student t5", model_of({{"white_noise", {1.0}}}), [](Random& random, std::vector<double>& x) {
                   for (double& value : x) {
                     value = random.student(5.0) / std::sqrt(5.0 / 3.0);
                   }
                 }});
  all.push_back({"QN (uniform)", model_of({{"quantization_noise", {1.0}}}), {}});
  return all;
}

}  // namespace

TEST(Accuracy, VarianceIntervalsCoverTheTruth) {
  Section section("variance");
  section.print(
      "\n## Intervals of the wavelet variance\n\nCoverage [%%] of nominal 95 %%: lowest and highest over scales, the "
      "last-but-one scale, and the last.\n\n| truth | N | repetitions | lowest-highest | last but one | last |\n"
      "|---|---|---|---|---|---|\n");
  for (const std::size_t samples : {std::size_t{1} << 10U, std::size_t{1} << 14U, std::size_t{1} << 17U}) {
    const std::size_t runs = repetitions(2000);
    for (const Truth& truth : truths()) {
      std::vector<std::size_t> hits;
      const HaarVariance grid = haar_variance(std::vector<double>(samples, 0.0), 0.0);
      HaarCovariance plan(grid.half, samples, kDt);
      hits.assign(grid.scales(), 0);
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(1000 + samples, run);
        std::vector<double> x(samples, 0.0);
        if (truth.simulate) {
          truth.simulate(random, x);
        } else {
          x = simulate(truth.model, random, kDt, samples);
        }
        const HaarVariance curve = haar_variance(x, x[0]);
        const VarianceIntervals intervals = variance_intervals(curve, plan, difference_excess_kurtosis(x));
        for (std::size_t j = 0; j < curve.scales(); ++j) {
          const double expected = haar_variance(truth.model, static_cast<double>(curve.half[j]), kDt);
          hits[j] += intervals.ci95[j].contains(expected) ? 1 : 0;
        }
      }
      double low = 100.0;
      double high = 0.0;
      std::vector<double> percent;
      for (std::size_t j = 0; j < hits.size(); ++j) {
        percent.push_back(100.0 * static_cast<double>(hits[j]) / static_cast<double>(runs));
        if (j + 2 != hits.size()) {
          low = std::min(low, percent.back());
          high = std::max(high, percent.back());
        }
      }
      section.print("| %s | %zu | %zu | %.1f-%.1f | %.1f | %.1f |\n", truth.name, samples, runs, low, high,
                    percent[percent.size() - 2], percent.back());
      // Promised: at least 93 % (92 % for the two that are not Gaussian); three standard errors of the simulation below
      // it.
      EXPECT_GT(low, 92.0 - 300.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(runs))) << truth.name;
    }
  }
}

}  // namespace driftlab::accuracy
