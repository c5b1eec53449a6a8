#include "core/navigate/drive/profile_parabola.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr std::size_t kFewestBlocks = 6;

/// A parabola as slope in the middle of its lower half and curvature.
struct Parabola {
  double slope = 0.0, middle = 0.0, curvature = 0.0;
  Parabola(const std::array<double, 3>& at, const std::array<double, 3>& values)
      : slope((values[1] - values[0]) / (at[1] - at[0])), middle(0.5 * (at[0] + at[1])) {
    const double upper = (values[2] - values[1]) / (at[2] - at[1]);
    curvature = -2.0 * (upper - slope) / (at[2] - at[0]);
  }
  [[nodiscard]] double slope_at(double x) const { return slope - curvature * (x - middle); }
};

/// B/(B - 1) times the sum of squares about the mean.
double scatter(const std::vector<double>& slopes) {
  if (slopes.size() < 2) {
    return 0.0;
  }
  const auto many = static_cast<double>(slopes.size());
  const double mean = std::accumulate(slopes.begin(), slopes.end(), 0.0) / many;
  double squares = 0.0;
  for (const double slope : slopes) {
    squares += (slope - mean) * (slope - mean);
  }
  return many / (many - 1.0) * squares;
}

/// Neighbours joined; a last one without neighbour stays alone.
std::vector<double> in_pairs(const std::vector<double>& slopes) {
  std::vector<double> joined((slopes.size() + 1) / 2);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    joined[i / 2] += slopes[i];
  }
  return joined;
}

/// The largest scatter of the blocks, of pairs, of fours and so on.
double most_scatter(std::vector<double> blocks) {
  double most = scatter(blocks);
  while (blocks.size() >= 2 * kFewestBlocks) {
    blocks = in_pairs(blocks);
    most = std::max(most, scatter(blocks));
  }
  return most;
}

}  // namespace

double ProfilePoint::sum() const { return std::accumulate(blocks.begin(), blocks.end(), 0.0); }

ProfileEstimate parabola_through(const std::array<ProfilePoint, 3>& points) {
  ProfileEstimate estimate;
  const std::array<double, 3> at{points[0].at, points[1].at, points[2].at};
  const Parabola whole(at, {points[0].sum(), points[1].sum(), points[2].sum()});
  if (!(whole.curvature > 0.0) || !std::isfinite(whole.curvature)) {
    return estimate;
  }
  estimate.sound = true;
  estimate.value = std::clamp(whole.middle + whole.slope / whole.curvature, at[0], at[2]);
  const double from_middle = estimate.value - at[1];
  estimate.top = points[1].sum() + from_middle * 0.5 * (whole.slope_at(at[1]) + whole.slope_at(estimate.value));
  std::vector<double> slopes;
  for (std::size_t b = 0; b < points[1].blocks.size(); ++b) {
    slopes.push_back(
        Parabola(at, {points[0].blocks[b], points[1].blocks[b], points[2].blocks[b]}).slope_at(estimate.value));
  }
  const double most = most_scatter(std::move(slopes));
  estimate.curvature_se = std::sqrt(1.0 / whole.curvature);
  estimate.sandwich_se = std::sqrt(most) / whole.curvature;
  estimate.divisor = std::max(kLeastDivisor, most / whole.curvature);
  estimate.se = std::sqrt(estimate.divisor) * estimate.curvature_se;
  return estimate;
}

void judge_against_nothing(ProfileEstimate& estimate, double value, const ProfilePoint& top,
                           const ProfilePoint& nothing) {
  const double gain = top.sum() - nothing.sum();
  if (!(gain > 0.0) || !std::isfinite(gain)) {
    return;
  }
  std::vector<double> gains = top.blocks;
  for (std::size_t b = 0; b < gains.size(); ++b) {
    gains[b] -= nothing.blocks[b];
  }
  estimate.divisor = std::max(kLeastDivisor, 0.5 * most_scatter(std::move(gains)) / gain);
  estimate.score = gain / estimate.divisor;
  estimate.se = std::abs(value) / std::sqrt(2.0 * estimate.score);
}

}  // namespace driftlab::drive
