#include "core/investigate/search/usable_group.hpp"

#include "core/investigate/study/reference_quality.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Relative. Clocks differ by far less, another setting of the sensor by far more. Chosen, not measured.
constexpr double kSameRate = 0.01;
/// Of all recordings together. Chosen, not measured.
constexpr double kFewestSamples = 500.0;

}  // namespace

UsableGroup usable_group(const ChannelGroup& group) {
  double samples = 0.0;
  bool constant = true;
  for (const auto& member : group.members) {
    samples += static_cast<double>(member.recording->count());
    const auto [low, high] = std::minmax_element(member.channel->rows.begin(), member.channel->rows.end());
    constant = constant && *low == *high;
    if (std::fabs(member.recording->dt_s / group.members.front().recording->dt_s - 1.0) > kSameRate) {
      return {"its recordings have different sampling rates", "recordings at one sampling rate"};
    }
  }
  if (constant) {
    return {"it never changes", "a channel whose values change"};
  }
  if (samples < kFewestSamples) {
    return {"it has fewer than 500 samples", "500 samples or more"};
  }
  std::string misleads = why_reference_misleads(group);
  if (!misleads.empty()) {
    return {std::move(misleads), "a reference of the same motion, on the same clock and axes"};
  }
  return {};
}

}  // namespace driftlab::investigate
