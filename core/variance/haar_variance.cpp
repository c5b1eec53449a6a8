#include "core/variance/haar_variance.hpp"

#include "core/variance/wide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace driftlab {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kBlock = 2048;
/// Half lengths below this go through the pyramid, the rest through prefix sums.
constexpr std::size_t kPyramidEnd = 512;

/// Neumaier's compensated sum.
class CompensatedSum {
 public:
  void add(double value) {
    const double next = sum_ + value;
    carry_ += std::fabs(sum_) >= std::fabs(value) ? (sum_ - next) + value : (value - next) + sum_;
    sum_ = next;
  }
  [[nodiscard]] double value() const { return sum_ + carry_; }

 private:
  double sum_ = 0.0;
  double carry_ = 0.0;
};

/// Sum of squares of now[i] - before[i]; next[i] = now[i] + before[i].
DRIFTLAB_WIDE double pyramid_step(const double* now, const double* before, double* next, std::size_t first,
                                  std::size_t count) {
  for (std::size_t i = 0; i < first; ++i) {
    next[i] = now[i] + before[i];
  }
  std::array<double, kLanes> sum{};
  std::size_t i = first;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double a = now[i + k];
      const double b = before[i + k];
      const double d = a - b;
      sum[k] += d * d;
      next[i + k] = a + b;
    }
  }
  for (; i < count; ++i) {
    const double d = now[i] - before[i];
    sum[0] += d * d;
    next[i] = now[i] + before[i];
  }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

/// Sum of squares of a[i] - 2 b[i] + c[i].
DRIFTLAB_WIDE double second_difference_power(const double* a, const double* b, const double* c, std::size_t count) {
  std::array<double, kLanes> sum{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double d = (a[i + k] - b[i + k]) - (b[i + k] - c[i + k]);
      sum[k] += d * d;
    }
  }
  for (; i < count; ++i) {
    const double d = (a[i] - b[i]) - (b[i] - c[i]);
    sum[0] += d * d;
  }
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

/// Short scales: level j keeps the last m sums of m samples in front of the block's own.
class Pyramid {
 public:
  explicit Pyramid(std::size_t levels) : levels_(levels), buffer_(levels + 1), power_(levels) {
    for (std::size_t j = 0; j <= levels; ++j) {
      buffer_[j].assign((std::size_t{1} << j) + kBlock, 0.0);
    }
  }

  /// Takes samples start .. start + count - 1.
  void push(const double* samples, std::size_t start, std::size_t count, double pivot) {
    if (levels_ == 0) {
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      buffer_[0][1 + i] = samples[i] - pivot;
    }
    for (std::size_t j = 0; j < levels_; ++j) {
      const std::size_t m = std::size_t{1} << j;
      double* const past = buffer_[j].data();
      const std::size_t ready = 2 * m - 1;  // first time index with a whole filter behind it
      const std::size_t first = start >= ready ? 0 : std::min(ready - start, count);
      power_[j].add(pyramid_step(past + m, past, buffer_[j + 1].data() + 2 * m, first, count));
      std::memmove(past, past + count, m * sizeof(double));
    }
  }

  [[nodiscard]] double power(std::size_t level) const { return power_[level].value(); }

 private:
  std::size_t levels_;
  std::vector<std::vector<double>> buffer_;
  std::vector<CompensatedSum> power_;
};

}  // namespace

HaarVariance haar_variance(std::span<const double> samples, double pivot) {
  HaarVariance result;
  const std::size_t n = samples.size();
  result.samples = n;
  std::size_t short_levels = 0;
  for (std::size_t m = 1; 2 * m <= n; m *= 2) {
    result.half.push_back(m);
    short_levels += m < kPyramidEnd ? 1 : 0;
  }
  const std::size_t levels = result.half.size();
  Pyramid pyramid(short_levels);
  std::vector<CompensatedSum> power(levels);
  std::vector<double> prefix(levels > short_levels ? n + 1 : 1, 0.0);
  double block_base = 0.0;
  double base_carry = 0.0;
  for (std::size_t start = 0; start < n; start += kBlock) {
    const std::size_t count = std::min(kBlock, n - start);
    pyramid.push(samples.data() + start, start, count, pivot);
    if (levels == short_levels) {
      continue;
    }
    double inside = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      inside += samples[start + i] - pivot;
      prefix[start + i + 1] = block_base + (inside + base_carry);
    }
    const double next = block_base + (inside + base_carry);
    base_carry = (inside + base_carry) - (next - block_base);
    block_base = next;
    for (std::size_t j = short_levels; j < levels; ++j) {
      const std::size_t m = result.half[j];
      const std::size_t end = start + count;
      const std::size_t first = std::max(start + 1, 2 * m);
      if (first > end) {
        break;
      }
      const double* const now = prefix.data() + first;
      power[j].add(second_difference_power(now, now - m, now - 2 * m, end - first + 1));
    }
  }
  for (std::size_t j = 0; j < levels; ++j) {
    const double m = static_cast<double>(result.half[j]);
    const double total = j < short_levels ? pyramid.power(j) : power[j].value();
    result.variance.push_back(total / (4.0 * m * m) / static_cast<double>(result.coefficients(j)));
  }
  return result;
}

}  // namespace driftlab
