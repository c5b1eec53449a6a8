// All candidates of a curve are measured alike: one covariance, one discrepancy. On the recorded axes each candidate
// used to freeze its own covariance: 121 of 972 pairs of nested models were in the wrong order, the best fit of gyro z
// had long-scale variances hundreds of times too small, and its beta was 189/s where the ranked distance has its
// minimum at 284/s. The curves are those of 18 static axes, as numbers in tests/data/reference.
#include "core/fit/candidate_set.hpp"

#include "core/fit/characterise.hpp"
#include "core/fit/j_test.hpp"
#include "core/variance/variance_intervals.hpp"
#include "tests/reference_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

struct Curve {
  std::string name;
  WaveletMoments moments;
  Eigen::VectorXd sd;
  CurveCovariance logarithms;
};

Curve curve_of(std::string name, HaarVariance variances) {
  const double largest = *std::max_element(variances.variance.begin(), variances.variance.end());
  for (double& variance : variances.variance) {
    variance /= largest;
  }
  HaarCovariance plan(variances.half, variances.samples, kDt);
  const VarianceIntervals intervals = variance_intervals(variances, plan);
  Curve curve;
  curve.name = std::move(name);
  curve.moments = {
      Eigen::Map<const Eigen::VectorXd>(variances.variance.data(), static_cast<Eigen::Index>(variances.scales())),
      {plan.half().begin(), plan.half().end()},
      static_cast<double>(variances.samples),
      kDt};
  curve.sd = intervals.estimate_variance.cwiseSqrt();
  curve.logarithms = curve_covariance(curve.moments.nu, intervals.modelled, plan.matrix(intervals.mixture));
  return curve;
}

/// The octave curves of the 18 static axes, the last scale included.
std::vector<Curve> recorded_curves() {
  std::vector<Curve> curves;
  for (const char* recording : {"adis_16405_imu1", "adis_16405_imu2", "adis_16405_imu3"}) {
    const auto file = reference_values(std::string(recording) + ".smac.json");
    for (const auto& [axis_name, axis] : file["axes"].items()) {
      HaarVariance variances;
      variances.samples = file["n"].get<std::size_t>();
      variances.variance = axis["wv_haar_modwt"]["variance"].get<std::vector<double>>();
      variances.variance.push_back(axis["checks"]["last_scale_wv_numpy"]);
      for (std::size_t j = 0; j < variances.variance.size(); ++j) {
        variances.half.push_back(std::size_t{1} << j);
      }
      curves.push_back(curve_of(std::string(recording) + " " + axis_name, std::move(variances)));
    }
  }
  return curves;
}

CandidateSet fitted_set(const Curve& curve) {
  std::vector<ModelStructure> structures;
  for (const std::string& name : CharacteriseOptions{}.models) {
    structures.push_back(*parse_model(name));
  }
  CandidateSet set = *fit_candidates(curve.moments, structures, curve.sd, curve.logarithms);
  EXPECT_TRUE(forgive(curve.moments, set).has_value());
  return set;
}

const Candidate& best_of(const CandidateSet& set, double samples) {
  return *std::min_element(set.candidates.begin(), set.candidates.end(), [&](const Candidate& a, const Candidate& b) {
    return a.criterion(samples) < b.criterion(samples);
  });
}

/// |ln| of the ratio of modelled to estimated variance, per scale.
Eigen::VectorXd deviations(const Curve& curve, const Candidate& candidate) {
  const Eigen::VectorXd modelled = modelled_variance(curve.moments, candidate.log_fit->model());
  return (modelled.array() / curve.moments.nu.array()).log().abs();
}

TEST(CandidateSet, NoLargerModelIsFartherThanOneItContainsAndTheLargestIsAtItsDegreesOfFreedom) {
  int pairs = 0;
  for (const Curve& curve : recorded_curves()) {
    const CandidateSet set = fitted_set(curve);
    ASSERT_EQ(set.candidates.size(), 9U);
    for (const Candidate& inner : set.candidates) {
      for (const Candidate& outer : set.candidates) {
        if (inner.structure != outer.structure && is_nested(inner.structure, outer.structure)) {
          ++pairs;
          EXPECT_LE(outer.fit.objective, inner.fit.objective * (1.0 + 1e-9))
              << curve.name << ": " << model_name(outer.structure) << " over " << model_name(inner.structure);
        }
      }
    }
    EXPECT_GT(set.curve->delta, 0.0) << curve.name << ": none of the nine is true";
    const Candidate& largest = set.candidates.back();
    EXPECT_NEAR(largest.fit.objective / distance_dof(largest), 1.0, 0.06) << curve.name;
  }
  EXPECT_EQ(pairs, 18 * 27);
}

TEST(CandidateSet, TheRecordedCurvesAreFollowedWhereTheyAreKnown) {
  int within = 0;
  for (const Curve& curve : recorded_curves()) {
    const CandidateSet set = fitted_set(curve);
    const Eigen::VectorXd off = deviations(curve, best_of(set, curve.moments.samples));
    bool followed = true;
    double slow = 0.0;
    for (Eigen::Index j = 0; j < off.size(); ++j) {
      const double edf = curve.logarithms.edf(j);
      if (edf < 20.0) {
        continue;
      }
      // In deviations: 20 %, or what a true model misses at some scale by chance.
      followed = followed && 0.5 * off(j) <= std::max(std::log(1.2), 2.6 / std::sqrt(2.0 * edf));
      slow = curve.moments.half[static_cast<std::size_t>(j)] >= 64.0 ? std::max(slow, off(j)) : slow;
    }
    within += followed ? 1 : 0;
    if (curve.name.ends_with("gyro_z")) {
      EXPECT_LE(slow, 0.16) << curve.name << ": a resonance at the first scales must not rule the long ones";
    }
  }
  EXPECT_GE(within, 14);
}

TEST(CandidateSet, ParametersAreTheMinimumOfTheRankedDistance) {
  // Searches that start elsewhere come back to the same point: 0.1 % in each parameter that the curve determines at
  // all.
  for (const Curve& curve : recorded_curves()) {
    if (!curve.name.ends_with("gyro_z")) {
      continue;
    }
    const CandidateSet set = fitted_set(curve);
    for (const Candidate& candidate : set.candidates) {
      const LogFit& fit = *candidate.log_fit;
      const Eigen::VectorXd known = fit.sandwich();
      for (const double factor : {0.5, 1.5}) {
        for (std::size_t k = 0; k < fit.coordinates().size(); ++k) {
          const auto i = static_cast<Eigen::Index>(k);
          Eigen::VectorXd start = fit.best();
          start(i) += std::log(factor);
          const LogFit again(curve.moments, fit.model_at(start), set.curve);
          EXPECT_GE(again.minimum(), fit.minimum() - 1e-6 * fit.minimum()) << curve.name;
          if (again.minimum() < fit.minimum() + 1e-6) {
            for (Eigen::Index c = 0; c < known.size(); ++c) {
              EXPECT_TRUE(known(c) > 1.0 || std::fabs(again.best()(c) - fit.best()(c)) < 1e-3)
                  << curve.name << " " << model_name(candidate.structure) << " coordinate " << c;
            }
          }
        }
      }
    }
  }
}

TEST(CandidateSet, ATrueModelIsAcceptedWithoutDiscrepancy) {
  const Model truth{*make_process("white_noise", {0.02}), *make_process("gauss_markov", {0.05, 0.5})};
  int forgiven = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const std::vector<double> x = simulate(truth, random, kDt, 30000);
    const auto found = characterise_channel({.values = x, .dt_s = kDt});
    ASSERT_TRUE(found.has_value());
    forgiven += found->discrepancy > 0.0 ? 1 : 0;
    for (const ModelFit& fit : found->fits) {
      ASSERT_TRUE(fit.j_test.has_value());
      EXPECT_EQ(fit.verdict == "accepted", fit.j_test->p >= kRejected) << fit.model;
      EXPECT_EQ(fit.described_within == 0.0, fit.verdict == "accepted") << fit.model;
    }
  }
  EXPECT_LE(forgiven, 3);  // 1 % each by chance: more than 3 of 40 has a probability of 0.001
}

TEST(CandidateSet, IntervalsAllowForWhatTheModelMisses) {
  // White noise averaged over 6 samples is none of the candidates: said, with the size, and no interval pretends to 0.3
  // %.
  Random random(5);
  std::vector<double> white = simulate({*make_process("white_noise", {0.1})}, random, kDt, 200005);
  std::vector<double> x;
  for (std::size_t t = 5; t < white.size(); ++t) {
    x.push_back((white[t] + white[t - 1] + white[t - 2] + white[t - 3] + white[t - 4] + white[t - 5]) / 6.0);
  }
  const auto found = characterise_channel({.values = x, .dt_s = kDt});
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(found->discrepancy, 0.02);
  const ModelFit& best = found->fits.front();
  EXPECT_EQ(best.verdict, "not_described");
  EXPECT_GE(best.described_within, found->discrepancy);
  for (const FittedProcess& process : best.processes) {
    if (const auto& level = process.parameters.front().estimate) {
      EXPECT_GT(std::log(level->ci95.high / level->ci95.low), 0.02) << process.kind->name;
    }
  }
  // From a tau past the filter on, white noise it is.
  const auto slow = characterise_channel({.values = x, .dt_s = kDt}, {.from_tau_s = 0.64});
  ASSERT_TRUE(slow.has_value());
  EXPECT_EQ(slow->fits.front().model, "WN");
  EXPECT_EQ(slow->fits.front().verdict, "accepted");
  const Estimate& n = *slow->fits.front().processes.front().parameters.front().estimate;
  EXPECT_TRUE(n.ci95.contains(0.1)) << n.ci95.low << " " << n.ci95.high;
  EXPECT_EQ(slow->haar.scale, found->haar.scale) << "the curves are those of all scales";
  const auto never = characterise_channel({.values = x, .dt_s = kDt}, {.from_tau_s = 1e6});
  ASSERT_TRUE(never.has_value());
  EXPECT_TRUE(never->fits.empty());
  EXPECT_FALSE(check_options({.from_tau_s = -1.0}).has_value());
  EXPECT_FALSE(check_options({.from_tau_s = std::nan("")}).has_value());
}

}  // namespace
}  // namespace driftlab
