#include "core/variance/gappy_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

/// Mean of the recorded samples, about: sums are formed relative to it so that an offset costs no digits.
double recorded_mean(const GappySamples& samples) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    const double there = samples.is_missing(t) ? 0.0 : 1.0;
    sum += there * samples.values[t];
    count += there;
  }
  return count > 0.0 && std::isfinite(sum) ? sum / count : 0.0;
}

constexpr std::size_t kBlock = 8192;
constexpr std::size_t kPollBlocks = 8;

}  // namespace

WholeWindowScan::WholeWindowScan(const GappySamples& samples)
    : size_(samples.size()), prefix_(std::make_unique_for_overwrite<double[]>(samples.size() + 1)) {
  const double pivot = recorded_mean(samples);
  std::array<double, kBlock> centred;  // NOLINT: written before it is read
  prefix_[0] = 0.0;
  double base = 0.0;
  double carry = 0.0;
  bool open = false;
  for (std::size_t first = 0; first < size_; first += kBlock) {
    const std::size_t count = std::min(kBlock, size_ - first);
    for (std::size_t i = 0; i < count; ++i) {
      if (samples.is_missing(first + i)) {
        centred[i] = 0.0;
        open = false;
        continue;
      }
      centred[i] = samples.values[first + i] - pivot;
      if (!open) {
        start_.push_back(first + i);
        stretch_.push_back(0);
        open = true;
      }
      ++stretch_.back();
    }
    extend_prefix(std::span(centred).first(count), 0.0, base, carry, prefix_.get() + first + 1);
  }
}

std::size_t WholeWindowScan::windows(std::size_t half) const {
  std::size_t count = 0;
  for (const std::size_t length : stretch_) {
    count += length >= 2 * half ? length - 2 * half + 1 : 0;
  }
  return count;
}

std::optional<WholeWindows> WholeWindowScan::at(std::size_t half) const { return at(std::span(&half, 1)).front(); }

std::vector<std::optional<WholeWindows>> WholeWindowScan::at(std::span<const std::size_t> half,
                                                             const RunControl& control) const {
  std::vector<double> sum(half.size(), 0.0);
  std::vector<std::size_t> next(half.size(), 0);  // the first stretch that may reach into the block, per scale
  for (std::size_t first = 0; first < size_; first += kBlock) {
    if (first / kBlock % kPollBlocks == 0 && control.stop.stop_requested()) {
      break;
    }
    const std::size_t last = std::min(size_, first + kBlock);  // windows that end with samples first .. last - 1
    for (std::size_t j = 0; j < half.size(); ++j) {
      const std::size_t m = half[j];
      for (std::size_t& i = next[j]; i < stretch_.size(); ++i) {
        const std::size_t end = start_[i] + stretch_[i];
        if (m > 0 && stretch_[i] >= 2 * m) {
          const std::size_t from = std::max(first, start_[i] + 2 * m - 1) + 1;
          const std::size_t to = std::min(last, end) + 1;
          if (from < to) {
            const double* const now = prefix_.get() + from;
            sum[j] += kernels().second_difference_power(now, now - m, now - 2 * m, to - from);
          }
        }
        if (end >= last) {
          break;  // it, or the next one, reaches beyond the block
        }
      }
    }
  }
  std::vector<std::optional<WholeWindows>> result(half.size());
  for (std::size_t j = 0; j < half.size(); ++j) {
    const std::size_t count = half[j] > 0 && 2 * half[j] <= size_ ? windows(half[j]) : 0;
    if (count > 0) {
      const double width = 2.0 * static_cast<double>(half[j]);
      result[j] = {.variance = sum[j] / (width * width) / static_cast<double>(count),
                   .windows = count,
                   .share = static_cast<double>(count) / static_cast<double>(size_ - 2 * half[j] + 1)};
    }
  }
  return result;
}

}  // namespace driftlab
