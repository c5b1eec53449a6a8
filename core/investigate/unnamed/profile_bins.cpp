#include "core/investigate/unnamed/profile_bins.hpp"

#include <algorithm>
#include <cstddef>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kQuantiles = 12;

}  // namespace

std::size_t bin_of(const std::vector<double>& edge, double x) {
  const auto above = std::upper_bound(edge.begin(), edge.end(), x) - edge.begin();
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(edge.size()) - 2));
}

std::vector<double> edges_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::vector<double> distinct = values;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<double> edge;
  if (distinct.size() < 2) {
    return edge;
  }
  edge.push_back(distinct.front());
  if (distinct.size() <= 2 * kQuantiles) {
    for (std::size_t k = 1; k < distinct.size(); ++k) {
      edge.push_back(0.5 * (distinct[k - 1] + distinct[k]));
    }
  } else {
    for (std::size_t k = 1; k < kQuantiles; ++k) {
      edge.push_back(values[k * values.size() / kQuantiles]);
    }
  }
  edge.push_back(distinct.back());
  edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
  return edge.size() > 2 ? edge : std::vector<double>{};
}

}  // namespace driftlab::investigate
