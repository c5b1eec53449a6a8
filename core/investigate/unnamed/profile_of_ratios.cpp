#include "core/investigate/unnamed/profile_of_ratios.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::investigate {
namespace {

constexpr double kDeepest = 0.02;  ///< ratio: what is deeper is told as this deep

}  // namespace

double level_of(const std::vector<RatioBin>& bins) {
  RatioBin all;
  for (const RatioBin& bin : bins) {
    all += bin;
  }
  return all.weight > 0.0 && all.sum > 0.0 ? all.sum / all.weight : 1.0;
}

std::vector<RatioBin> at_level(std::vector<RatioBin> bins, double level) {
  for (RatioBin& bin : bins) {
    bin.sum /= level;
  }
  return bins;
}

RatioProfile profile_of(const std::vector<RatioBin>& bins) {
  RatioProfile profile;
  double square = 0.0;
  double count = 0.0;
  for (const RatioBin& bin : bins) {
    const bool empty = !(bin.weight > 0.0);
    profile.value.push_back(empty ? 1.0 : bin.sum / bin.weight);
    profile.se.push_back(empty ? std::numeric_limits<double>::infinity() : 1.0 / std::sqrt(bin.weight));
    if (!empty) {
      square += (profile.value.back() - 1.0) * (profile.value.back() - 1.0) - 1.0 / bin.weight;
      count += 1.0;
    }
  }
  const double prior = std::max(0.0, square / std::max(1.0, count));
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double own = bins[b].weight > 0.0 ? prior / (prior + 1.0 / bins[b].weight) : 0.0;
    profile.value[b] = std::max(kDeepest, 1.0 + own * (profile.value[b] - 1.0));
  }
  return profile;
}

double gain_of(const RatioProfile& profile, const std::vector<RatioBin>& bins) {
  double gain = 0.0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    gain += bins[b].sum * (1.0 - 1.0 / profile.value[b]) - bins[b].weight * std::log(profile.value[b]);
  }
  return gain;
}

}  // namespace driftlab::investigate
