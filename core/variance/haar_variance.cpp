#include "core/variance/haar_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

namespace driftlab {
namespace {

constexpr std::size_t kBlock = 4096;
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
      power_[j].add(kernels().pyramid_step(past + m, past, buffer_[j + 1].data() + 2 * m, first, count));
      std::memmove(past, past + count, m * sizeof(double));
    }
  }

  [[nodiscard]] double power(std::size_t level) const { return power_[level].value(); }

 private:
  std::size_t levels_;
  std::vector<std::vector<double>> buffer_;
  std::vector<CompensatedSum> power_;
};

/// Adds the squares of the long filters that end in this block.
void long_scales(const double* prefix, std::size_t start, std::size_t count, std::span<const std::size_t> half,
                 std::span<CompensatedSum> power) {
  std::size_t whole = 0;  // levels whose filter fits before every end of the block
  while (whole < half.size() && 2 * half[whole] <= start + 1) {
    ++whole;
  }
  std::array<double, 64> sum{};
  if (whole > 0) {
    kernels().octave_powers(prefix + start + 1, half[0], whole, count, sum.data());
  }
  for (std::size_t j = whole; j < half.size() && 2 * half[j] <= start + count; ++j) {
    const std::size_t first = 2 * half[j];
    kernels().octave_powers(prefix + first, half[j], 1, start + count - first + 1, &sum[j]);
  }
  for (std::size_t j = 0; j < half.size(); ++j) {
    power[j].add(sum[j]);
  }
}

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
  // Not initialised: every element is written before it is read, and touching 8 N bytes twice would show.
  const auto prefix = std::make_unique_for_overwrite<double[]>(levels > short_levels ? n + 1 : 1);
  prefix[0] = 0.0;
  double block_base = 0.0;
  double base_carry = 0.0;
  for (std::size_t start = 0; start < n; start += kBlock) {
    const std::size_t count = std::min(kBlock, n - start);
    pyramid.push(samples.data() + start, start, count, pivot);
    if (levels == short_levels) {
      continue;
    }
    extend_prefix(samples.subspan(start, count), pivot, block_base, base_carry, prefix.get() + start + 1);
    long_scales(prefix.get(), start, count, std::span(result.half).subspan(short_levels),
                std::span(power).subspan(short_levels));
  }
  for (std::size_t j = 0; j < levels; ++j) {
    const double m = static_cast<double>(result.half[j]);
    const double total = j < short_levels ? pyramid.power(j) : power[j].value();
    result.variance.push_back(total / (4.0 * m * m) / static_cast<double>(result.coefficients(j)));
  }
  return result;
}

}  // namespace driftlab
