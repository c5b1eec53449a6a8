#include "core/variance/gappy_variance.hpp"

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

}  // namespace driftlab
