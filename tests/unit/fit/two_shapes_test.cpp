/// Every fit took a process to have one shape at most; a resonance has two, its frequency and its quality.
#include "core/fit/gmwm.hpp"
#include "core/fit/log_fit.hpp"
#include "core/variance/haar_covariance.hpp"
#include "tests/likelihood/kalman_likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kSamples = 8192;

Model truth() {
  return {*make_process("white_noise", {0.02}), *make_process("random_walk", {0.05}),
          *make_process("resonance", {0.5, 13.0, 6.0})};
}

struct Octaves {
  std::vector<std::size_t> half;
  WaveletMoments moments;

  explicit Octaves(const Model& model) {
    for (std::size_t m = 1; 2 * m <= kSamples; m *= 2) {
      half.push_back(m);
      moments.half.push_back(static_cast<double>(m));
    }
    moments.samples = kSamples;
    moments.dt_s = kDt;
    moments.nu = modelled_variance(moments, model);
  }
};

TEST(TwoShapes, AreFoundFromTheCurveOfTheModelItself) {
  const Octaves octaves(truth());
  const GmwmSolution found =
      fit_gmwm(octaves.moments, *parse_model("WN+RW+RES"), MomentWeights::from_sd(octaves.moments.nu));
  ASSERT_EQ(found.model.size(), 3U);
  EXPECT_LT(found.objective, 1e-8);
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t k = 0; k < found.model[p].parameters.size(); ++k) {
      EXPECT_NEAR(found.model[p].parameters[k], truth()[p].parameters[k], 1e-2 * truth()[p].parameters[k])
          << found.model[p].kind->name << " " << k;
    }
  }
}

TEST(TwoShapes, HaveAnIntervalEach) {
  const Octaves octaves(truth());
  HaarCovariance plan(octaves.half, kSamples, kDt);
  const CurveCovariance curve = curve_covariance(octaves.moments.nu, octaves.moments.nu, plan.matrix(truth()));
  LogFit fit(octaves.moments, truth(), std::make_shared<const WhitenedCurve>(whitened(curve, 0.0)));
  ASSERT_EQ(fit.coordinates().size(), 5U);
  EXPECT_EQ(fit.coordinates()[3].parameter, 1U);
  EXPECT_EQ(fit.coordinates()[4].parameter, 2U);
  for (const auto& [k, value] : {std::pair{std::size_t{3}, 13.0}, {4, 6.0}}) {
    const Interval interval = fit.profile(k, 3.84);
    EXPECT_LT(interval.low, std::log(value));
    EXPECT_GT(interval.high, std::log(value));
    EXPECT_LT(interval.high - interval.low, 2.0);
  }
}

TEST(TwoShapes, AreFoundByTheLikelihood) {
  Random random(3);
  const std::vector<double> x = simulate(truth(), random, kDt, kSamples);
  Model start = truth();
  start[2].parameters = {0.4, 14.0, 4.0};
  const auto fit = maximise_likelihood(x, start, kDt);
  ASSERT_TRUE(fit);
  // Line width 13/6 Hz over 82 s is 178 degrees of freedom: frequency to 0.04 Hz in 13, width and level to 8 %, four of
  // them.
  EXPECT_NEAR(fit->model[2].parameters[0], 0.5, 0.16);
  EXPECT_NEAR(fit->model[2].parameters[1], 13.0, 0.3);
  EXPECT_NEAR(fit->model[2].parameters[2], 6.0, 2.0);
}

}  // namespace
}  // namespace driftlab
