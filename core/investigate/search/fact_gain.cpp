#include "core/investigate/search/fact_gain.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Log score of k events among n at rate p.
double bernoulli(double k, double n, double p) { return k * std::log(p) + (n - k) * std::log1p(-p); }

double lattice_gain(const Channel& channel) {
  const auto middle = channel.rows.size() / 2;
  const std::span<const double> parts[2] = {channel.rows.first(middle), channel.rows.subspan(middle)};
  double gain = 0.0;
  for (std::size_t half = 0; half < 2; ++half) {
    const Lattice lattice = find_lattice(parts[half]);
    if (!(lattice.step > 0.0) || !(lattice.decimals > 0.0)) {
      continue;
    }
    const double worth = std::log(std::max(1.0, lattice.step / lattice.decimals));
    for (const double v : parts[1 - half]) {
      const double q = v / lattice.step;
      const bool on = std::fabs(q - std::round(q)) * lattice.step < 1.6 * lattice.decimals + 0.02 * lattice.step;
      gain += on ? worth : -worth;
    }
  }
  return gain;
}

}  // namespace

void hold_out_fact(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& mask, Evidence& found) {
  const std::string_view name = found.cause->name;
  if (name == "timestamp_jitter") {
    return;
  }
  double gain = 0.0;
  double samples = 0.0;
  double events[2] = {0.0, 0.0};
  double places[2] = {0.0, 0.0};
  for (const std::size_t r : found.members) {
    const Channel& channel = *group.members[r].channel;
    const std::size_t length = channel.valid.size();
    samples += static_cast<double>(length);
    if (name == "output_resolution") {
      gain += lattice_gain(channel);
      continue;
    }
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t half = 2 * i / length;
      const bool event = name == "missing_samples" ? channel.valid[i] == 0 : mask[r][i] != 0;
      events[half] += event ? 1.0 : 0.0;
      places[half] += 1.0;
    }
  }
  if (name != "output_resolution") {
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
