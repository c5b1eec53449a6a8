#include "core/investigate/search/fact_gain.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Log score of k events among n at rate p.
double bernoulli(double k, double n, double p) { return k * std::log(p) + (n - k) * std::log1p(-p); }

}  // namespace

void hold_out_fact(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& spoilt, Evidence& found) {
  const FileFact& fact = *found.cause->as<FileFact>();
  if (fact.log_gain == nullptr && fact.events == nullptr && fact.spoils == nullptr) {
    return;
  }
  double gain = 0.0;
  double samples = 0.0;
  double events[2] = {0.0, 0.0};
  double places[2] = {0.0, 0.0};
  std::vector<unsigned char> marked;
  for (const std::size_t r : found.members) {
    const Channel& channel = *group.members[r].channel;
    const std::size_t length = channel.valid.size();
    samples += static_cast<double>(length);
    if (fact.log_gain != nullptr) {
      gain += fact.log_gain(channel);
      continue;
    }
    if (fact.events != nullptr) {
      marked.assign(length, 0);
      fact.events(channel, marked);
    }
    const std::vector<unsigned char>& at = fact.events != nullptr ? marked : spoilt[r];
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t half = 2 * i / length;
      events[half] += at[i] != 0 ? 1.0 : 0.0;
      places[half] += 1.0;
    }
  }
  if (fact.log_gain == nullptr) {
    for (std::size_t half = 0; half < 2; ++half) {
      const double never = 1.0 / places[1 - half];
      const double rate = std::clamp(events[half] / places[half], never, 1.0 - never);
      gain +=
          bernoulli(events[1 - half], places[1 - half], rate) - bernoulli(events[1 - half], places[1 - half], never);
    }
  }
  found.heldout_gain = gain;
  found.heldout_samples = samples;
  found.heldout = true;
}

}  // namespace driftlab::investigate
