// Sample-wise robust variance with gross errors, patches and gaps; coefficient-wise on coarse lattices.
#include "core/fit/sample_wise_variance.hpp"
#include "core/variance/gappy_variance.hpp"
#include "core/variance/lattice.hpp"
#include "core/variance/robust_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::accuracy {
namespace {

constexpr std::size_t kSamples = 8192;

struct Truth {
  const char* name;
  Model model;
};

std::vector<Truth> truths() {
  return {{"WN", model_of({{"white_noise", {1.0}}})},
          {"WN+GM+RW", model_of({{"white_noise", {1.0}}, {"gauss_markov", {0.3, 0.02}}, {"random_walk", {0.001}}})},
          {"RW", model_of({{"random_walk", {1.0}}})},
          {"QN+WN", model_of({{"quantization_noise", {1.0}}, {"white_noise", {0.3}}})}};
}

enum class Spoil { Nothing, Samples, NoisyPatches, ShiftedPatches, GapsAtRandom, GapsInBursts };

struct Case {
  const char* name;
  Spoil kind;
  double share;
  double size;
  double allowed;  ///< deviation of the mean ratio
  double least_edf;
};

GappySamples spoil(std::vector<double> x, const Case& how, Random& random) {
  GappySamples result{std::move(x), {}};
  const std::size_t n = result.size();
  constexpr std::size_t kPatch = 50;
  const auto patches = static_cast<std::size_t>(std::lround(how.share * static_cast<double>(n) / kPatch));
  if (how.kind == Spoil::GapsAtRandom || how.kind == Spoil::GapsInBursts) {
    result.missing.assign(n, 0);
  }
  if (how.kind == Spoil::Samples || how.kind == Spoil::GapsAtRandom) {
    for (std::size_t t = 0; t < n; ++t) {
      if (random.uniform() >= how.share) {
        continue;
      }
      if (how.kind == Spoil::Samples) {
        result.values[t] += how.size * random.normal();
      } else {
        result.missing[t] = 1;
      }
    }
    return result;
  }
  for (std::size_t p = 0; how.kind != Spoil::Nothing && p < patches; ++p) {
    const std::size_t start = random.below(n - kPatch);
    const double shift = random.uniform() < 0.5 ? -how.size : how.size;
    for (std::size_t t = start; t < start + kPatch; ++t) {
      if (how.kind == Spoil::GapsInBursts) {
        result.missing[t] = 1;
      } else {
        result.values[t] += how.kind == Spoil::NoisyPatches ? how.size * random.normal() : shift;
      }
    }
  }
  return result;
}

struct Tally {
  std::vector<double> mean;
  std::vector<double> square;
  std::vector<double> classical;
  std::vector<double> classical_square;
  double runs = 0.0;
  double replaced = 0.0;
  double failures = 0.0;
};

Tally run_case(const Truth& truth, const Case& how, HaarCovariance& plan, std::size_t runs) {
  Tally tally;
  const std::size_t scales = plan.half().size();
  tally.mean.assign(scales, 0.0);
  tally.square.assign(scales, 0.0);
  tally.classical.assign(scales, 0.0);
  tally.classical_square.assign(scales, 0.0);
  for (std::size_t run = 0; run < runs; ++run) {
    Random random(5000, run);
    const std::vector<double> good = simulate(truth.model, random, 1.0, kSamples);
    const bool gaps = how.kind == Spoil::GapsAtRandom || how.kind == Spoil::GapsInBursts;
    const SampleWiseVariance found =
        sample_wise_variance(spoil(good, how, random), plan, {.seed = run + 1, .look_for_errors = !gaps});
    if (found.outcome != SampleWiseOutcome::Estimated) {
      tally.failures += 1.0;
      continue;
    }
    tally.runs += 1.0;
    tally.replaced += found.replaced_share;
    const HaarVariance own = haar_variance(good, good.front());
    for (std::size_t j = 0; j < scales; ++j) {
      const double expected = haar_variance(truth.model, plan.half()[j], 1.0);
      const double ratio = found.curve.variance[j] / expected;
      const double classical = own.variance[j] / expected;
      tally.mean[j] += ratio;
      tally.square[j] += ratio * ratio;
      tally.classical[j] += classical;
      tally.classical_square[j] += classical * classical;
    }
  }
  return tally;
}

}  // namespace

TEST(Accuracy, SampleWiseVarianceKeepsEveryScale) {
  Section section("sample_wise");
  section.print(
      "\n## Robust wavelet variance, sample by sample, and gaps\n\nN = %zu. Mean ratio to the truth over scales with "
      "edf "
      ">= 5 (gaps: 20), lowest-highest, both over the classical estimate of the unspoiled series (its own mean is 1 "
      "and "
      "its scatter cancels); efficiency: variance of that classical estimate over that of this one, at scales with edf "
      ">= "
      "50; share of recorded samples a draw replaces; runs without an estimate.\n\n| truth | spoiled by | runs | ratio "
      "| "
      "efficiency | replaced [%%] | failed |\n|---|---|---|---|---|---|---|\n",
      kSamples);
  const HaarVariance grid = haar_variance(std::vector<double>(kSamples, 0.0), 0.0);
  HaarCovariance plan(grid.half, kSamples, 1.0);
  const Case cases[] = {{"nothing", Spoil::Nothing, 0.0, 0.0, 0.1, 5.0},
                        {"1 % at 100 sd", Spoil::Samples, 0.01, 100.0, 0.1, 5.0},
                        {"0.1 % at 1,000 sd", Spoil::Samples, 0.001, 1000.0, 0.1, 5.0},
                        {"5 % at 5 sd", Spoil::Samples, 0.05, 5.0, 0.1, 5.0},
                        {"2 % in patches of 50, noise of 10 sd", Spoil::NoisyPatches, 0.02, 10.0, 0.25, 5.0},
                        {"2 % in patches of 50, shifted by 10 sd", Spoil::ShiftedPatches, 0.02, 10.0, 0.25, 5.0},
                        {"2 % in patches of 50, shifted by 5 sd", Spoil::ShiftedPatches, 0.02, 5.0, 0.25, 5.0},
                        {"5 % missing at random", Spoil::GapsAtRandom, 0.05, 0.0, 0.02, 20.0},
                        {"5 % missing in bursts of 50", Spoil::GapsInBursts, 0.05, 0.0, 0.02, 20.0}};
  for (const Truth& truth : truths()) {
    const Eigen::VectorXd variance = plan.diagonal(truth.model);
    for (const Case& how : cases) {
      const std::size_t runs = repetitions(200);
      const Tally tally = run_case(truth, how, plan, runs);
      const double n = std::max(tally.runs, 1.0);
      double low = 1e9;
      double high = 0.0;
      double least = 1e9;
      double most = 0.0;
      for (std::size_t j = 0; j < grid.scales(); ++j) {
        const double expected = haar_variance(truth.model, plan.half()[j], 1.0);
        const double edf = 2.0 * expected * expected / variance(static_cast<Eigen::Index>(j));
        if (edf < how.least_edf) {
          continue;
        }
        const double mean = tally.mean[j] / n;
        const double classical = tally.classical[j] / n;
        low = std::min(low, mean / classical);
        high = std::max(high, mean / classical);
        const double gain =
            (tally.classical_square[j] / n - classical * classical) / (tally.square[j] / n - mean * mean);
        least = edf >= 50.0 ? std::min(least, gain) : least;
        most = edf >= 50.0 ? std::max(most, gain) : most;
      }
      section.print("| %s | %s | %zu | %.3f-%.3f | %.2f-%.2f | %.1f | %.0f |\n", truth.name, how.name, runs, low, high,
                    least, most, 100.0 * tally.replaced / n, tally.failures);
      // Two standard errors of the mean ratio at edf 5 and an efficiency of 0.6 on top of what is allowed.
      const double noise = 2.0 * std::sqrt((1.0 / 0.6 - 1.0) * 2.0 / how.least_edf / static_cast<double>(runs));
      EXPECT_GT(low, 1.0 - how.allowed - noise) << truth.name << ' ' << how.name;
      EXPECT_LT(high, 1.0 + how.allowed + noise) << truth.name << ' ' << how.name;
    }
  }
}

TEST(Accuracy, LatticesAreCuredOrRefused) {
  Section section("lattice");
  section.print(
      "\n## Robust wavelet variance on a coarse lattice\n\nRounded white noise, N = 65,536. Mean ratio of the robust "
      "to "
      "the classical variance of the rounded values at n = 2, 4, 8, lowest-highest over offsets 0, 0.25, 0.5 of a "
      "step: as "
      "the equation gives it, and cured.\n\n| sd/step | runs | uncured | cured | refused [%%] "
      "|\n|---|---|---|---|---|\n");
  constexpr std::size_t kLong = 1U << 16U;
  for (const double sd : {1.0, 0.7, 0.6, 0.5, 0.4, 0.3}) {
    const std::size_t runs = repetitions(40);
    double low = 1e9;
    double high = 0.0;
    double raw_low = 1e9;
    double raw_high = 0.0;
    double refused = 0.0;
    double all = 0.0;
    for (const double offset : {0.0, 0.25, 0.5}) {
      std::vector<double> cured(3, 0.0);
      std::vector<double> raw(3, 0.0);
      double count = 0.0;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(5100, run);
        std::vector<double> x(kLong);
        std::generate(x.begin(), x.end(), [&] { return std::round(offset + sd * random.normal()); });
        const double pivot = summarise(x)->mean;
        const HaarVariance curve = haar_variance(x, pivot);
        HaarCovariance plan(curve.half, kLong, 1.0);
        const VarianceIntervals intervals = variance_intervals(curve, plan);
        const RobustShape shape = lattice_shape(x, 1.0, intervals, plan, run + 1);
        all += 1.0;
        if (shape.refused) {
          refused += 1.0;
          continue;
        }
        count += 1.0;
        const RobustVariance robust = robust_variance(x, pivot, curve, intervals, plan, shape);
        const RobustVariance uncured = robust_variance(x, pivot, curve, intervals, plan);
        for (std::size_t j = 0; j < cured.size(); ++j) {
          const double ratio = robust.variance[j].value_or(0.0) / curve.variance[j];
          cured[j] += ratio;
          raw[j] += uncured.variance[j].value_or(0.0) / curve.variance[j];
        }
      }
      for (std::size_t j = 0; count > 0.0 && j < cured.size(); ++j) {
        low = std::min(low, cured[j] / count);
        high = std::max(high, cured[j] / count);
        raw_low = std::min(raw_low, raw[j] / count);
        raw_high = std::max(raw_high, raw[j] / count);
      }
    }
    if (high > 0.0) {
      section.print("| %.1f | %zu | %.3f-%.3f | %.3f-%.3f | %.0f |\n", sd, runs, raw_low, raw_high, low, high,
                    100.0 * refused / all);
      if (sd >= kTooCoarseLattice) {
        EXPECT_NEAR(low, 1.0, sd < 0.45 ? 0.02 : 0.01) << sd;
        EXPECT_NEAR(high, 1.0, sd < 0.45 ? 0.02 : 0.01) << sd;
      }
    } else {
      section.print("| %.1f | %zu | | | %.0f |\n", sd, runs, 100.0 * refused / all);
    }
    EXPECT_TRUE(sd < kTooCoarseLattice ? refused > 0.95 * all : refused == 0.0) << sd;
  }
}

}  // namespace driftlab::accuracy
