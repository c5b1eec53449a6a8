/// stuck_samples: runs in which the last value repeats.
/// On a lattice repeats are normal: with a chance p that the next value is the same, runs of k repeats or more occur N
/// p^k times. Runs beyond the k at which that falls below 0.001 are stuck. Shorter stuck runs are counted by the
/// geometric law of the longer. A run of more than a hundredth of the record is a freeze: it says nothing about chance,
/// and one is enough.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace driftlab::investigate {
namespace {

struct Runs {
  std::vector<double> of;  ///< of[k]: runs with exactly k repeats
  double samples = 0.0;
  double chance = 0.0;       ///< of two equal neighbours without sticking, its upper end
  double coincidence = 0.0;  ///< share of equal values far apart
  double freeze = 0.0;       ///< repeats in the longest freeze; 0: none
  std::size_t freeze_row = 0;
};

/// The rows outside freezes.
std::vector<double> without_freezes(std::span<const double> v, Runs& runs) {
  const double least = std::max(100.0, 0.01 * static_cast<double>(v.size()));
  std::vector<double> rest;
  rest.reserve(v.size());
  for (std::size_t from = 0; from < v.size();) {
    std::size_t to = from + 1;
    while (to < v.size() && v[to] == v[from]) {
      ++to;
    }
    const auto repeats = static_cast<double>(to - from - 1);
    if (repeats <= least) {
      rest.insert(rest.end(), v.begin() + static_cast<std::ptrdiff_t>(from),
                  v.begin() + static_cast<std::ptrdiff_t>(to));
    } else if (repeats > runs.freeze) {
      runs.freeze = repeats;
      runs.freeze_row = from;
    }
    from = to;
  }
  return rest;
}

/// Largest share of one value in any of 32 parts of the record: while the mean stays there, a repeat is that likely.
double commonest_share(std::span<const double> values, const std::stop_token& stop) {
  // Parts of the record, short enough for a drifting mean to stay at one value. Chosen, not measured.
  constexpr std::size_t kParts = 32;
  double largest = 0.0;
  for (std::size_t part = 0; part < kParts && !stop.stop_requested(); ++part) {
    const std::size_t from = part * values.size() / kParts;
    const std::size_t to = (part + 1) * values.size() / kParts;
    std::vector<double> sorted(values.begin() + static_cast<std::ptrdiff_t>(from),
                               values.begin() + static_cast<std::ptrdiff_t>(to));
    std::sort(sorted.begin(), sorted.end());
    std::size_t run = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      run = i > 0 && sorted[i] == sorted[i - 1] ? run + 1 : 1;
      largest = std::max(largest, static_cast<double>(run) / static_cast<double>(sorted.size()));
    }
  }
  return largest;
}

/// The chance is that of equal values far apart; on a lattice, where neighbours are alike, also the share of the
/// commonest value and the share of runs that go on after one repeat.
Runs count_runs(const StudyRecording& recording, const Channel& channel, const std::stop_token& stop) {
  Runs runs;
  runs.of.assign(2, 0.0);
  runs.samples = static_cast<double>(channel.rows.size());
  std::size_t repeats = 0;
  double equal_far = 0.0;
  const double limit = clipped_at(channel);  // values at it repeat without being stuck
  for (std::size_t i = 1; i <= channel.rows.size(); ++i) {
    const bool clipped = limit > 0.0 && i < channel.rows.size() && at_limit(channel.rows[i], limit);
    if (i < channel.rows.size() && channel.rows[i] == channel.rows[i - 1] && !clipped) {
      ++repeats;
      continue;
    }
    if (repeats >= runs.of.size()) {
      runs.of.resize(repeats + 1, 0.0);
    }
    runs.of[repeats] += 1.0;
    repeats = 0;
  }
  if (stop.stop_requested()) {
    return runs;
  }
  const std::vector<double> v = without_freezes(channel.rows, runs);
  const auto awake = static_cast<double>(v.size());
  // Samples apart at which a repeat is chance: a prime, so that no even period falls on it. Chosen, not measured.
  constexpr std::size_t kFar = 37;
  for (std::size_t i = kFar; i < v.size(); ++i) {
    equal_far += v[i] == v[i - kFar] ? 1.0 : 0.0;
  }
  // An upper end of the chance: few coincidences say little about it.
  const double far = (equal_far + 3.0 * std::sqrt(equal_far) + 5.0) / std::max(1.0, awake - kFar);
  runs.coincidence = equal_far / std::max(1.0, awake - kFar);
  double once = 0.0;
  double twice = 0.0;
  for (std::size_t k = 1; k < runs.of.size(); ++k) {
    once += runs.of[k];
    twice += k > 1 ? runs.of[k] : 0.0;
  }
  const double goes_on = 1.15 * twice / std::max(1.0, once);
  runs.chance = far;
  const double step = find_lattice(v, stop).step * channel.unit.factor;
  const double noise = noise_of_differences(recording, channel);
  if (far > 0.01 || step > 0.02 * noise) {
    // Gaussian noise about the middle of a lattice place stays on it with erf(step / (2 sqrt(2) sigma)).
    const double behind = noise_behind_lattice(noise, step);
    const double stays = behind > 0.0 ? std::erf(0.5 * step / std::numbers::sqrt2 / behind) : 1.0;
    runs.chance = std::min(0.999, std::max({far, goes_on, commonest_share(v, stop), stays}));
  }
  return runs;
}

std::size_t longest_by_chance(const Runs& runs) {
  if (!(runs.chance > 0.0)) {
    return 1;
  }
  const double k = std::log(1e-3 / std::max(1.0, runs.samples)) / std::log(std::min(runs.chance, 0.99999));
  return static_cast<std::size_t>(std::max(1.0, std::ceil(k)));
}

struct Stuck {
  double runs = 0.0;     ///< with at least `from` repeats
  double repeats = 0.0;  ///< in them
  std::size_t from = 1;
};

Stuck stuck_in(const Runs& runs) {
  Stuck stuck;
  stuck.from = longest_by_chance(runs);
  for (std::size_t k = stuck.from; k < runs.of.size(); ++k) {
    stuck.runs += runs.of[k];
    stuck.repeats += static_cast<double>(k) * runs.of[k];
  }
  return stuck;
}

std::vector<Evidence> find(const ChannelGroup& group, const std::stop_token& stop) {
  Evidence evidence;
  double runs = 0.0;
  double repeats = 0.0;
  double samples = 0.0;
  double variance = 0.0;
  bool unseen = false;  // short runs hide among coincidences
  std::size_t from = 1;
  for (std::size_t r = 0; r < group.members.size() && !stop.stop_requested(); ++r) {
    const Channel& channel = *group.members[r].channel;
    const auto [low, high] = std::minmax_element(channel.rows.begin(), channel.rows.end());
    if (*low == *high) {
      continue;  // a constant channel is another matter
    }
    const Runs all = count_runs(*group.members[r].recording, channel, stop);
    const Stuck stuck = stuck_in(all);
    const bool freezes = all.freeze >= static_cast<double>(stuck.from);
    if (stuck.repeats < 4.0 || (stuck.runs < 2.0 && !freezes)) {
      continue;
    }
    if (freezes) {
      const double dt_s = group.members[r].recording->dt_s;
      char note[96];
      std::snprintf(note, sizeof note, "The longest run begins %.1f s after the first sample and lasts %.1f s.",
                    static_cast<double>(all.freeze_row) * dt_s, all.freeze * dt_s);
      evidence.note = note;
    }
    evidence.members.push_back(r);
    from = std::max(from, stuck.from);
    const double k0 = static_cast<double>(stuck.from);
    // Geometric law: mean m with m = mean(repeats | >= k0) - (k0 - 1); runs in all M = M_k0 / g^(k0-1), g = 1 - 1/m.
    // Where coincidence is rare, shorter runs are counted too, less what it gives; else their law is unknown.
    const bool direct = all.chance < 0.01;
    double shorter = 0.0;
    double shorter_repeats = 0.0;
    for (std::size_t k = 1; direct && k < stuck.from && k < all.of.size(); ++k) {
      const double by_chance = all.samples * std::pow(all.coincidence, static_cast<double>(k));
      shorter += std::max(0.0, all.of[k] - by_chance);
      shorter_repeats += static_cast<double>(k) * std::max(0.0, all.of[k] - by_chance);
    }
    const double m = std::max(1.0, direct ? (stuck.repeats + shorter_repeats) / (stuck.runs + shorter)
                                          : stuck.repeats / stuck.runs - (k0 - 1.0));
    const double g = 1.0 - 1.0 / m;
    const double total = direct ? stuck.runs + shorter : stuck.runs / std::pow(std::max(g, 0.05), k0 - 1.0);
    unseen = unseen || !direct;
    runs += total;
    repeats += total * m;
    samples += all.samples;
    variance += total * (1.0 + (k0 - 1.0) * 0.5);
  }
  if (evidence.members.empty()) {
    return {};
  }
  const double mean = repeats / runs;
  const double fraction = repeats / samples;
  // Where short runs are not seen, runs of a single repeat may not occur at all: the mean is then one more.
  // The number of runs is Poisson, their lengths geometric of variance m (m - 1).
  const double sd_mean = std::sqrt(std::max(mean * (mean - 1.0), 0.1) / runs) * (from > 1 ? 1.2 : 1.0);
  const double sd_fraction = std::sqrt(mean * (2.0 * mean - 1.0) * variance) / samples;
  evidence.score = 1000.0 + repeats;
  evidence.gain = evidence.score;
  evidence.parameters = {
      {"fraction",
       {fraction, {std::max(0.0, fraction - 1.96 * sd_fraction), std::min(1.0, fraction + 1.96 * sd_fraction)}},
       units::one(group.unit)},
      {"mean_run",
       {mean, {std::max(1.0, mean - 1.96 * sd_mean), mean + 1.96 * sd_mean + (unseen ? 1.0 : 0.0)}},
       units::one(group.unit)}};
  return {evidence};
}

/// Repeats of runs that chance does not explain.
void spoils(const ChannelGroup& group, const Evidence& /*found*/, std::size_t r, std::vector<unsigned char>& mask) {
  const Channel& channel = *group.members[r].channel;
  const std::size_t from = longest_by_chance(count_runs(*group.members[r].recording, channel, {}));
  std::size_t row = 0;
  std::size_t run_start = 0;
  double last = 0.0;
  std::vector<std::size_t> places;  // grid places of the present run's repeats
  for (std::size_t i = 0; i < channel.valid.size(); ++i) {
    if (channel.valid[i] == 0) {
      continue;
    }
    const double v = channel.rows[row];
    if (row > 0 && v == last) {
      places.push_back(i);
    } else {
      places.clear();
      run_start = i;
    }
    if (places.size() == from) {
      for (const std::size_t place : places) {
        mask[place] = 1;
      }
    } else if (places.size() > from) {
      mask[i] = 1;
    }
    last = v;
    ++row;
  }
  (void)run_start;
}

/// Runs start at random; their lengths are geometric with the mean asked for.
void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double start = values[0] / values[1];
  std::vector<unsigned char> repeat(draft.white.size(), 0);
  for (std::size_t i = 1; i < repeat.size(); ++i) {
    if (random.uniform() < start) {
      do {
        repeat[i++] = 1;
      } while (i < repeat.size() && random.uniform() > 1.0 / values[1]);
    }
  }
  draft.output.emplace_back([repeat](std::vector<double>& out) {
    for (std::size_t i = 1; i < out.size(); ++i) {
      out[i] = repeat[i] != 0 ? out[i - 1] : out[i];
    }
  });
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.002 * stage.z, 6.0}; }

}  // namespace

Cause stuck_samples() {
  return {.name = "stuck_samples",
          .title = "runs in which the last value repeats",
          .equation =
              "z(k) = z(k−1) within runs; mean run: repeats in a run on the average; fraction: repeats of all samples",
          .family = FileFact{.find = find, .spoils = spoils},
          .rivals = {},
          .needs = "any recording",
          .separates = "",
          .parameters = {{"fraction", units::one}, {"mean_run", units::one}},
          .inject = inject_effect,
          .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
