#include "core/variance/gappy_variance.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// Mean of the recorded samples: sums are formed relative to it.
double recorded_mean(const GappySamples& samples) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (!samples.is_missing(t)) {
      count += 1.0;
      sum += (samples.values[t] - sum) / count;  // running mean: no overflow, few lost digits
    }
  }
  return sum;
}

/// Sum over l of h_l h_{l+lag} that the windows ending at or after `newest` and starting at or before `oldest` of the
/// record put on one pair, h = -1/(2m) for the older half and +1/(2m) for the newer.
double pair_weight(std::ptrdiff_t half, std::ptrdiff_t lag, std::ptrdiff_t first_place, std::ptrdiff_t last_place) {
  // Places l of the newer sample of the pair, 0 .. 2m - 1 - lag; the older sits at l + lag. Signs agree where both are
  // in one half: l + lag < m, or l >= m.
  const auto count = [](std::ptrdiff_t low, std::ptrdiff_t high) {
    return std::max<std::ptrdiff_t>(0, high - low + 1);
  };
  const std::ptrdiff_t newer = count(first_place, std::min(last_place, half - 1 - lag));
  const std::ptrdiff_t older = count(std::max(first_place, half), last_place);
  const std::ptrdiff_t all = count(first_place, last_place);
  return static_cast<double>(2 * (newer + older) - all);
}

}  // namespace

WholeWindowScan::WholeWindowScan(const GappySamples& samples) : centred_(samples.size(), 0.0) {
  const double pivot = recorded_mean(samples);
  bool open = false;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (samples.is_missing(t)) {
      open = false;
      continue;
    }
    centred_[t] = samples.values[t] - pivot;
    if (!open) {
      start_.push_back(t);
      stretch_.push_back(0);
      open = true;
    }
    ++stretch_.back();
  }
}

std::size_t WholeWindowScan::windows(std::size_t half) const {
  std::size_t count = 0;
  for (const std::size_t length : stretch_) {
    count += length >= 2 * half ? length - 2 * half + 1 : 0;
  }
  return count;
}

std::optional<WholeWindows> WholeWindowScan::at(std::size_t half) const {
  const std::size_t n = centred_.size();
  if (half == 0 || 2 * half > n || windows(half) == 0) {
    return std::nullopt;
  }
  double newer = 0.0;
  double older = 0.0;
  std::size_t t = 0;
  for (; t < half; ++t) {
    newer += centred_[t];
  }
  const auto shift = [&](std::size_t to) {
    for (; t < to; ++t) {
      newer += centred_[t];
      newer -= centred_[t - half];
      older += centred_[t - half];
      if (t >= 2 * half) {
        older -= centred_[t - 2 * half];
      }
    }
  };
  WholeWindows result;
  double sum = 0.0;
  const double width = 2.0 * static_cast<double>(half);
  for (std::size_t i = 0; i < stretch_.size(); ++i) {
    if (stretch_[i] < 2 * half) {
      continue;
    }
    const std::size_t end = start_[i] + stretch_[i];
    shift(start_[i] + 2 * half - 1);
    result.windows += end - t;
    const auto take = [&] {
      const double w = (newer - older) / width;
      sum += w * w;
    };
    shift(t + 1);  // the first of the record still has nothing behind it
    take();
    for (; t < end; ++t) {
      newer += centred_[t];
      newer -= centred_[t - half];
      older += centred_[t - half];
      older -= centred_[t - 2 * half];
      take();
    }
  }
  result.variance = sum / static_cast<double>(result.windows);
  result.share = static_cast<double>(result.windows) / static_cast<double>(n - 2 * half + 1);
  return result;
}

std::optional<WholeWindows> whole_window_variance(const GappySamples& samples, std::size_t half) {
  return WholeWindowScan(samples).at(half);
}

std::optional<double> pairwise_variance(const GappySamples& samples, std::size_t half) {
  const std::size_t n = samples.size();
  if (half == 0 || 2 * half > n) {
    return std::nullopt;
  }
  const double windows = static_cast<double>(n - 2 * half + 1);
  double total = 0.0;
  for (std::size_t lag = 1; lag < 2 * half; ++lag) {
    // The pair (s, s - lag) stands at places l = t - s of the windows that end at t, 2m - 1 <= t <= n - 1.
    double squares = 0.0;
    double there = 0.0;
    double possible = 0.0;
    const auto places = static_cast<std::ptrdiff_t>(2 * half - 1 - lag);  // largest place
    for (std::size_t s = lag; s < n; ++s) {
      const auto first =
          std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(2 * half - 1) - static_cast<std::ptrdiff_t>(s));
      const auto last = std::min<std::ptrdiff_t>(places, static_cast<std::ptrdiff_t>(n - 1 - s));
      if (last < first) {
        continue;
      }
      const double weight =
          pair_weight(static_cast<std::ptrdiff_t>(half), static_cast<std::ptrdiff_t>(lag), first, last);
      possible += 1.0;
      if (!samples.is_missing(s) && !samples.is_missing(s - lag)) {
        const double difference = samples.values[s] - samples.values[s - lag];
        there += 1.0;
        squares += weight * difference * difference;
      }
    }
    if (there == 0.0) {
      return std::nullopt;
    }
    total -= squares * possible / there;  // both orders of the pair: twice one half
  }
  const double scale = 4.0 * static_cast<double>(half) * static_cast<double>(half);
  return total / scale / windows;
}

}  // namespace driftlab
