/// What a profile is drawn against, and how its means are estimated, where recordings do not visit every bin.
#include "core/investigate/unnamed/profile_of_means.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace driftlab::investigate {
namespace {

/// Inner products of means and indicators of bins in recordings of white noise of unit variance, each less a constant
/// of its own. `means[r][b]`: of n[r][b] values.
Eigen::MatrixXd gram_of(const std::vector<std::vector<double>>& n, const std::vector<std::vector<double>>& means) {
  const auto bins = static_cast<Eigen::Index>(n.front().size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(bins + 1, bins + 1);
  for (std::size_t r = 0; r < n.size(); ++r) {
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(bins + 1, bins + 1);
    Eigen::VectorXd constant = Eigen::VectorXd::Zero(bins + 1);
    double all = 0.0;
    for (Eigen::Index b = 0; b < bins; ++b) {
      const double count = n[r][static_cast<std::size_t>(b)];
      const double mean = means[r][static_cast<std::size_t>(b)];
      own(0, 0) += count * mean * mean;
      own(0, b + 1) = own(b + 1, 0) = count * mean;
      own(b + 1, b + 1) = count;
      constant[0] += count * mean;
      constant[b + 1] = count;
      all += count;
    }
    sum += own - constant * constant.transpose() / all;
  }
  return sum;
}

/// A recording at rest lies in one bin alone, which no other passes through: the bins of those that move have a level
/// that is any, and a profile all the same.
TEST(FitBinMeans, FindsAProfileBesideABinThatNoRecordingKnowsBesideOthers) {
  const Eigen::MatrixXd gram = gram_of({{400.0, 400.0, 0.0, 400.0, 400.0}, {0.0, 0.0, 1600.0, 0.0, 0.0}},
                                       {{1.0, 1.0, 0.0, -1.0, -1.0}, {0.0, 0.0, 7.0, 0.0, 0.0}});
  const BinMeans fit = fit_bin_means(gram);
  for (const Eigen::Index b : {0, 1, 3, 4}) {
    EXPECT_NEAR(fit.amplitude[b], b < 2 ? 1.0 : -1.0, 0.02) << b;
    EXPECT_NEAR(fit.se[b], 0.05, 0.01) << b << ": of 400 values beside the constant";
  }
  EXPECT_NEAR(fit.amplitude[2], 0.0, 0.02);
  EXPECT_GE(fit.se[2], fit.se[0]) << "nothing is known of it";
}

/// One bin of few values is far off by chance: those of many say that there is a profile.
TEST(FitBinMeans, AreNotMadeNothingByOneBinThatIsHardlyKnown) {
  const Eigen::MatrixXd gram = gram_of({{400.0, 400.0, 1.0, 400.0, 400.0}}, {{0.5, 0.5, 0.1, -0.5, -0.5}});
  const BinMeans fit = fit_bin_means(gram);
  EXPECT_NEAR(fit.amplitude[0] - fit.amplitude[4], 1.0, 0.05);
}

TEST(FitBinMeans, OfNoiseAloneAreDrawnToNothing) {
  const Eigen::MatrixXd gram = gram_of({{400.0, 400.0, 400.0}}, {{0.02, -0.03, 0.01}});
  EXPECT_EQ(fit_bin_means(gram).amplitude.cwiseAbs().maxCoeff(), 0.0) << "within a standard error of 0.05";
}

/// Four seconds before and behind: a ramp has its slope everywhere, the ends that of their first and last eight
/// seconds; what is shorter has none.
TEST(CourseOf, WarmingIsTheSlopeOfTheTemperature) {
  StudyRecording recording;
  recording.dt_s = 0.1;
  recording.length = 600;
  std::vector<double> temperature(recording.length);
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    const double t = recording.time_s(i);
    temperature[i] = 300.0 + (t < 30.0 ? 0.02 * t : 0.6 - 0.01 * (t - 30.0));
  }
  recording.temperature = temperature;
  const Series slope = course_of(Against::Warming, recording, 2);
  ASSERT_EQ(slope.size(), recording.length);
  EXPECT_NEAR(slope[0], 0.02, 1e-9);
  EXPECT_NEAR(slope[200], 0.02, 1e-9);
  EXPECT_NEAR(slope[300], 0.005, 5e-4) << "half of each";
  EXPECT_NEAR(slope[599], -0.01, 1e-9);
  recording.temperature = std::vector<double>(temperature.begin(), temperature.begin() + 70);
  EXPECT_TRUE(course_of(Against::Warming, recording, 2).empty());
}

}  // namespace
}  // namespace driftlab::investigate
