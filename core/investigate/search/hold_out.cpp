#include "core/investigate/search/hold_out.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace driftlab::investigate {
namespace {

/// Short ones, so that a change near the start of a recording is seen by both folds.
constexpr std::size_t kSegments = 128;

/// The data with only one fold's samples in use.
FullRate fold_of(const FullRate& data, std::size_t fold) {
  FullRate part = data;
  for (auto& used : part.used) {
    for (std::size_t i = 0; i < used.size(); ++i) {
      if ((i * kSegments / used.size()) % 2 != fold) {
        used[i] = 0;
      }
    }
  }
  return part;
}

/// Where half of the samples in use have passed.
std::size_t middle_of(const std::vector<unsigned char>& used) {
  const auto count = std::count_if(used.begin(), used.end(), [](unsigned char u) { return u != 0; });
  auto at = used.begin();
  for (std::ptrdiff_t passed = 0; at != used.end() && passed < count / 2; ++at) {
    passed += *at != 0 ? 1 : 0;
  }
  return static_cast<std::size_t>(at - used.begin());
}

/// Half of the samples in use of every recording, with its own spectra.
FullRate half_of(const FullRate& data, std::size_t half) {
  FullRate part = data;
  for (std::size_t r = 0; r < data.members(); ++r) {
    const std::size_t middle = middle_of(data.used[r]);
    const std::size_t from = half == 0 ? 0 : middle;
    const std::size_t count = half == 0 ? middle : data.used[r].size() - middle;
    part.residual[r] = data.residual[r].part(from, count);
    part.innovation[r] = data.innovation[r].part(from, count);
    const auto first = data.used[r].begin() + static_cast<std::ptrdiff_t>(from);
    part.used[r].assign(first, first + static_cast<std::ptrdiff_t>(count));
    renew_spectrum(part, r);
  }
  return part;
}

/// What a part of the data shows of a finding; nothing where it is not seen there.
std::optional<Evidence> train_on(const FullRate& part, const Evidence& found) {
  const Cause& cause = *found.cause;
  const SpectralLine* const line = cause.as<SpectralLine>();
  std::vector<Evidence> all = line != nullptr ? std::vector{line->find_again(part, found)} : examine_of(cause)(part);
  for (Evidence& evidence : all) {
    if (evidence.members == found.members) {
      evidence.cause = &cause;
      return std::move(evidence);
    }
  }
  return std::nullopt;
}

/// Gaussian log likelihood gained by the deviations a modulation implies; scales are those of the fold where free.
double gain_of_deviation(const FullRate& test, const Evidence& trained) {
  double n = 0.0;
  double plain = 0.0;
  double divided = 0.0;
  double logs = 0.0;
  std::vector<double> sd;
  // Levels of other recordings say nothing where they do not repeat.
  const NoiseLevel& level = *trained.cause->as<NoiseLevel>();
  const bool alone = level.within_recording && !test.given && test.repeatability > 1.0;
  for (std::size_t r = 0; r < test.members(); ++r) {
    if (alone && r != trained.members.front()) {
      continue;
    }
    level.deviation(test, trained, r, sd);
    for (std::size_t i = 0; i < sd.size(); ++i) {
      if (test.used[r][i] != 0) {
        const double e = test.innovation[r][i];
        n += 1.0;
        plain += e * e;
        divided += e * e / (sd[i] * sd[i]);
        logs += std::log(sd[i]);
      }
    }
  }
  if (n == 0.0) {
    return 0.0;
  }
  if (test.given) {
    return 0.5 * (plain - divided) - logs;
  }
  return 0.5 * n * std::log(plain / divided) - logs;
}

/// Log likelihood that a cause of a family with `log_gain` gains on data it was not fitted to; null for the others.
using LogGain = double (*)(const FullRate& data, const Evidence& found);
LogGain log_gain_of(const Cause& cause) {
  return std::visit(
      [](const auto& family) -> LogGain {
        if constexpr (requires(const FullRate& data, const Evidence& found) { family.log_gain(data, found); }) {
          return family.log_gain;
        } else {
          return nullptr;
        }
      },
      cause.family);
}

}  // namespace

void hold_out(const FullRate& data, Evidence& found) {
  const LogGain log_gain = log_gain_of(*found.cause);
  const bool halves = log_gain != nullptr;
  double gain = 0.0;
  double samples = 0.0;
  for (const auto& e : data.residual) {
    samples += static_cast<double>(e.size());
  }
  for (std::size_t fold = 0; fold < 2 && !data.stopped(); ++fold) {
    const FullRate train = halves ? half_of(data, fold) : fold_of(data, fold);
    const FullRate test = halves ? half_of(data, 1 - fold) : fold_of(data, 1 - fold);
    const std::optional<Evidence> trained = train_on(train, found);
    if (!trained || data.stopped()) {
      continue;  // nothing would have been added, nothing gained
    }
    gain += halves ? log_gain(test, *trained) : gain_of_deviation(test, *trained);
  }
  found.heldout_gain = gain;
  found.heldout_samples = samples;
  found.heldout = true;
}

}  // namespace driftlab::investigate
