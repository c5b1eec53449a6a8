#include "core/fit/stationarity.hpp"

#include "core/signal/number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kTriplesPerBlock = 16;
constexpr std::size_t kBlock = 3 * kTriplesPerBlock;
constexpr std::array<std::size_t, 3> kFactors{1, 8, 64};  ///< of blocks, and half lengths of coefficients
constexpr std::size_t kFewestLevels = 30;
constexpr double kJump = 8.0;
constexpr double kFarthest =
    6.0;  ///< means of medians of three |c| at half length 1: four standard deviations of white noise
constexpr std::size_t kBatches = 32;
constexpr std::size_t kFewestMedians = 192;
constexpr double kBridge = 2.6;
constexpr std::size_t kMostChanges = 16;

double median_of_three(double a, double b, double c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

/// Means of the samples of each block, those beyond `reach` from the block's middle moved to it. The middle is the mean
/// of the middle half of the triple medians.
std::vector<double> block_levels(std::span<const double> samples, double reach) {
  std::vector<double> levels(samples.size() / kBlock);
  std::array<double, kTriplesPerBlock> medians{};
  for (std::size_t b = 0; b < levels.size(); ++b) {
    const double* const block = samples.data() + b * kBlock;
    for (std::size_t k = 0; k < kTriplesPerBlock; ++k) {
      medians[k] = median_of_three(block[3 * k], block[3 * k + 1], block[3 * k + 2]);
    }
    std::sort(medians.begin(), medians.end());
    double middle = 0.0;
    for (std::size_t k = kTriplesPerBlock / 4; k < 3 * kTriplesPerBlock / 4; ++k) {
      middle += 2.0 / kTriplesPerBlock * medians[k];
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      sum += std::clamp(block[i] - middle, -reach, reach);
    }
    levels[b] = middle + sum / kBlock;
  }
  return levels;
}

/// Means of `factor` successive values.
std::vector<double> coarsened(const std::vector<double>& values, std::size_t factor) {
  std::vector<double> means(values.size() / factor);
  for (std::size_t i = 0; i < means.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < factor; ++k) {
      sum += values[i * factor + k];
    }
    means[i] = sum / static_cast<double>(factor);
  }
  return means;
}

/// A change within one part; `excess` is its statistic over what is asked for.
struct Found {
  NoiseChange change;
  double excess = 0.0;
};

/// The row in [first, last) behind which the triple medians differ most from those before: the best cut in two means.
std::size_t sharpest_cut(std::span<const double> samples, std::size_t first, std::size_t last) {
  std::vector<double> medians;
  for (std::size_t i = first; i + 3 <= last; i += 3) {
    medians.push_back(median_of_three(samples[i], samples[i + 1], samples[i + 2]));
  }
  double mean = 0.0;
  for (const double value : medians) {
    mean += value / static_cast<double>(medians.size());
  }
  double sum = 0.0;
  double most = 0.0;
  std::size_t cut = medians.size() / 2;
  const auto count = static_cast<double>(medians.size());
  for (std::size_t k = 0; k + 1 < medians.size(); ++k) {
    sum += medians[k] - mean;
    const auto before = static_cast<double>(k + 1);
    const double contrast = sum * sum / (before * (count - before));
    if (contrast > most) {
      most = contrast;
      cut = k + 1;
    }
  }
  return first + 3 * cut;
}

std::optional<Found> find_jump(std::span<const double> samples, const std::vector<double>& levels, std::size_t factor,
                               double dt_s) {
  if (levels.size() < kFewestLevels) {
    return std::nullopt;
  }
  // What is back four blocks later was a patch of gross errors, no jump.
  std::vector<double> sizes(levels.size() - 4);
  double mean = 0.0;
  std::size_t at = 0;
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    sizes[b] = std::min(std::abs(levels[b + 3] - levels[b + 1]), std::abs(levels[b + 4] - levels[b]));
    mean += sizes[b] / static_cast<double>(sizes.size());
    at = sizes[b] > sizes[at] ? b : at;
  }
  const double largest = sizes[at];
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  // On a lattice more than half of the differences may be 0. 1.2533 of the mean is the deviation of Gaussian ones.
  const double deviation = std::max(1.4826 * *middle, 0.6 * 1.2533 * mean);
  if (!(largest > kJump * deviation)) {
    return std::nullopt;
  }
  const std::size_t length = kBlock * factor;
  Found found;
  found.change.kind = NoiseChange::Kind::Jump;
  found.change.sample = sharpest_cut(samples, (at + 1) * length, (at + 4) * length);
  found.change.size = levels[at + 3] - levels[at + 1];
  found.change.half_s = static_cast<double>(length) * dt_s;
  found.change.statistic = largest / deviation;
  found.excess = found.change.statistic / kJump;
  return found;
}

/// Medians of three successive |c| of non-overlapping Haar coefficients of half length `half`.
std::vector<double> coefficient_medians(std::span<const double> samples, std::size_t half) {
  const auto coefficient = [&](std::size_t c) {
    const double* const from = samples.data() + 2 * half * c;
    double difference = 0.0;
    for (std::size_t i = 0; i < half; ++i) {
      difference += from[half + i] - from[i];
    }
    return std::abs(difference);
  };
  std::vector<double> medians(samples.size() / (6 * half));
  for (std::size_t i = 0; i < medians.size(); ++i) {
    medians[i] = median_of_three(coefficient(3 * i), coefficient(3 * i + 1), coefficient(3 * i + 2));
  }
  return medians;
}

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

std::optional<Found> find_level_change(const std::vector<double>& medians, std::size_t half, double dt_s) {
  if (medians.size() < kFewestMedians) {
    return std::nullopt;
  }
  const std::size_t batch = medians.size() / kBatches;
  double squares = 0.0;
  double before = 0.0;
  for (std::size_t b = 0; b < kBatches; ++b) {
    const double mean = mean_of(std::span(medians).subspan(b * batch, batch));
    squares += b > 0 ? (mean - before) * (mean - before) : 0.0;
    before = mean;
  }
  const double variance = 0.5 * squares / static_cast<double>(kBatches - 1) * static_cast<double>(batch);
  const double mean = mean_of(medians);
  double sum = 0.0;
  double most = 0.0;
  std::size_t cut = 0;
  for (std::size_t i = 0; i < medians.size(); ++i) {
    sum += medians[i] - mean;
    if (std::abs(sum) > most) {
      most = std::abs(sum);
      cut = i + 1;
    }
  }
  const double statistic = most / std::sqrt(variance * static_cast<double>(medians.size()));
  if (!(statistic > kBridge) || cut == 0 || cut == medians.size()) {
    return std::nullopt;
  }
  const double level = mean_of(std::span(medians).first(cut));
  Found found;
  found.change.kind = NoiseChange::Kind::Level;
  found.change.sample = 6 * half * cut;
  found.change.size = level > 0.0 ? mean_of(std::span(medians).subspan(cut)) / level : 0.0;
  found.change.half_s = static_cast<double>(half) * dt_s;
  found.change.statistic = statistic;
  found.excess = statistic / kBridge;
  return found;
}

/// The change of a part that stands out most.
std::optional<NoiseChange> find_change(std::span<const double> samples, double dt_s) {
  std::optional<Found> best;
  const auto take = [&](const std::optional<Found>& found) {
    if (found && (!best || found->excess > best->excess)) {
      best = found;
    }
  };
  std::vector<double> levels;
  for (const std::size_t factor : kFactors) {
    const std::vector<double> medians = coefficient_medians(samples, factor);
    if (factor == 1) {
      levels = block_levels(samples, kFarthest * mean_of(medians));
    }
    take(find_jump(samples, factor == 1 ? levels : coarsened(levels, factor), factor, dt_s));
    take(find_level_change(medians, factor, dt_s));
  }
  return best ? std::optional(best->change) : std::nullopt;
}

}  // namespace

Stationarity test_stationarity(std::span<const double> samples, double dt_s) {
  Stationarity result;
  result.last = samples.size();
  if (samples.size() < kFewestStationary) {
    return result;
  }
  result.tested = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, samples.size()}};
  while (!open.empty() && result.changes.size() < kMostChanges) {
    const auto [first, last] = open.front();
    open.erase(open.begin());
    if (last - first < kFewestStationary) {
      continue;
    }
    auto change = find_change(samples.subspan(first, last - first), dt_s);
    if (!change || change->sample == 0 || change->sample >= last - first) {
      continue;
    }
    change->sample += first;
    open.emplace_back(first, change->sample);
    open.emplace_back(change->sample, last);
    result.changes.push_back(*change);
  }
  std::sort(result.changes.begin(), result.changes.end(),
            [](const NoiseChange& a, const NoiseChange& b) { return a.sample < b.sample; });
  std::size_t from = 0;
  std::size_t longest = 0;
  const auto close = [&](std::size_t to) {
    if (to - from > longest) {
      longest = to - from;
      result.first = from;
      result.last = to;
    }
    from = to;
  };
  for (const NoiseChange& change : result.changes) {
    close(change.sample);
  }
  close(samples.size());
  return result;
}

std::vector<std::string> describe(const Stationarity& found, double dt_s) {
  constexpr std::size_t kMostSentences = 4;
  std::vector<std::string> sentences;
  const auto seconds = [dt_s](std::size_t sample) { return short_text(static_cast<double>(sample) * dt_s) + " s"; };
  for (const NoiseChange& change : found.changes) {
    if (sentences.size() == kMostSentences) {
      sentences.push_back("There are " + std::to_string(found.changes.size() - kMostSentences) + " more changes.");
      break;
    }
    sentences.push_back(change.kind == NoiseChange::Kind::Jump
                            ? "Not one noise: the level jumps " + seconds(change.sample) +
                                  " after the first sample, by " + short_text(change.statistic) +
                                  " standard deviations of the levels over " + short_text(change.half_s) + " s."
                            : "Not one noise: from " + seconds(change.sample) + " after the first sample on it is " +
                                  short_text(change.size) + " times as strong as before, over " +
                                  short_text(change.half_s) + " s.");
  }
  if (!found.changes.empty()) {
    sentences.push_back("The longest part without a change is from " + seconds(found.first) + " to " +
                        seconds(found.last) +
                        " after the first sample; a model of the whole describes none of its parts.");
  }
  return sentences;
}

}  // namespace driftlab
