#include "core/investigate/search/join_axes.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

bool joined(const Evidence& a, const Evidence& b) {
  const MeanEffect* const effect = a.cause->as<MeanEffect>();
  return a.cause == b.cause && effect != nullptr && effect->one_for_all_axes && !a.parameters.empty() &&
         !b.parameters.empty();
}

double width_of(const Evidence& evidence) {
  const Interval& interval = evidence.parameters[0].estimate.ci95;
  return std::max(1e-12, interval.high - interval.low);
}

void add_to(Evidence& first, const Evidence& other) {
  const double wa = 1.0 / (width_of(first) * width_of(first));
  const double wb = 1.0 / (width_of(other) * width_of(other));
  Estimate& estimate = first.parameters[0].estimate;
  estimate.value = (wa * estimate.value + wb * other.parameters[0].estimate.value) / (wa + wb);
  const double half = 0.5 / std::sqrt(wa + wb);
  estimate.ci95 = {estimate.value - half, estimate.value + half};
  first.score += other.score;
  first.gain += other.gain;
  first.heldout_gain += other.heldout_gain;
  first.heldout_samples += other.heldout_samples;
  first.also_groups.push_back(other.group);
}

}  // namespace

void join_axes(std::vector<Evidence>& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = i + 1; j < found.size();) {
      if (joined(found[i], found[j])) {
        add_to(found[i], found[j]);
        found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        ++j;
      }
    }
  }
}

}  // namespace driftlab::investigate
