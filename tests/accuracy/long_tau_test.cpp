// Total variance and Theo1 as estimates of the Allan variance at the longest tau, noise model unknown.
#include "core/variance/long_tau.hpp"

#include "core/variance/samples.hpp"
#include "core/variance/variance_intervals.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace driftlab::accuracy {
namespace {

constexpr std::size_t kSamples = 8192;

/// Of one estimator at one tau over the repetitions.
struct Tally {
  double mean = 0.0;
  double squares = 0.0;
  double covered = 0.0;
  double edf = 0.0;
};

/// The entry whose tau is nearest to `tau`, as a ratio to the truth there.
template <class Curve>
void count(const Curve& curve, const std::vector<double>& variance, double tau, const Model& truth, double runs,
           Tally& tally) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < curve.tau_s.size(); ++k) {
    best = std::fabs(curve.tau_s[k] - tau) < std::fabs(curve.tau_s[best] - tau) ? k : best;
  }
  const double expected = 2.0 * haar_variance(truth, curve.tau_s[best], 1.0);
  const double ratio = variance[best] / expected;
  tally.mean += ratio / runs;
  tally.squares += ratio * ratio / runs;
  tally.covered += curve.ci95[best].contains(expected) ? 100.0 / runs : 0.0;
  tally.edf += curve.edf[best] / runs;
}

}  // namespace

TEST(Accuracy, TotalAndTheo1AtTheLongestTau) {
  Section section("long_tau");
  const std::size_t runs = repetitions(400);
  section.print(
      "\n## Total variance and Theo1 at the longest tau\n\nMean over the true Allan variance, relative root mean "
      "square "
      "error, mean degrees of freedom said, and coverage [%%] of nominal 95 %%. %zu samples, %zu repetitions; the "
      "noise "
      "is read off each record.\n\n| truth | tau/T | Allan: mean, rmse, edf, coverage | total | Theo1 |\n"
      "|---|---|---|---|---|\n",
      kSamples, runs);
  HaarCovariance plan(haar_variance(std::vector<double>(kSamples, 0.0), 0.0).half, kSamples, 1.0);
  const std::vector<std::pair<const char*, Model>> truths{
      {"WN", model_of({{"white_noise", {1.0}}})},
      {"flicker", model_of({{"flicker_noise", {1.0}}})},
      {"RW", model_of({{"random_walk", {1.0}}})},
      {"WN+RW", model_of({{"white_noise", {1.0}}, {"random_walk", {0.01}}})},
      {"WN+GM", model_of({{"white_noise", {1.0}}, {"gauss_markov", {0.3, 0.01}}})}};
  const std::vector<double> shares{1.0 / 32.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 3.0 / 4.0};
  for (const auto& [name, model] : truths) {
    std::vector<std::array<Tally, 3>> tallies(shares.size());
    const auto weight = static_cast<double>(runs);
    for (std::size_t run = 0; run < runs; ++run) {
      Random random(2800, run);
      const std::vector<double> x = simulate(model, random, 1.0, kSamples);
      const double mean = summarise(x)->mean;
      const HaarVariance curve = haar_variance(x, mean);
      const VarianceIntervals intervals = variance_intervals(curve, plan);
      LongTauCurve allan;
      for (std::size_t j = 0; j < curve.scales(); ++j) {
        allan.tau_s.push_back(static_cast<double>(curve.half[j]));
        allan.variance.push_back(2.0 * curve.variance[j]);
        allan.ci95.push_back({2.0 * intervals.ci95[j].low, 2.0 * intervals.ci95[j].high});
        allan.edf.push_back(intervals.edf[j]);
      }
      const LongTauCurve total = total_curve(x, mean, 1.0, intervals.mixture, 1.0);
      const LongTauCurve theo = theo1_curve(x, mean, 1.0, intervals.mixture, 1.0);
      for (std::size_t k = 0; k < shares.size(); ++k) {
        const double tau = shares[k] * static_cast<double>(kSamples);
        count(allan, allan.variance, tau, model, weight, tallies[k][0]);
        count(total, total.variance, tau, model, weight, tallies[k][1]);
        count(theo, theo.variance, tau, model, weight, tallies[k][2]);
      }
    }
    for (std::size_t k = 0; k < shares.size(); ++k) {
      section.print("| %s | %.3f |", name, shares[k]);
      for (std::size_t e = 0; e < 3; ++e) {
        const Tally& tally = tallies[k][e];
        if (shares[k] > 0.5 && e < 2) {
          section.print(" - |");
          continue;
        }
        section.print(" %.2f, %.2f, %.1f, %.1f |", tally.mean, std::sqrt(tally.squares - 2.0 * tally.mean + 1.0),
                      tally.edf, tally.covered);
        EXPECT_GT(tally.covered, 88.0) << name << " " << shares[k] << " " << e;
      }
      section.print("\n");
    }
  }
}

}  // namespace driftlab::accuracy
