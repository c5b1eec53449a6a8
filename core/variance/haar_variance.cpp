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
constexpr std::size_t kPyramidEnd = 256;

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

/// Short scales, two levels at a time: buffer j holds the sums of m = 2^j samples, of the block and of the 3m before
/// it.
class Pyramid {
 public:
  explicit Pyramid(std::size_t levels) : levels_(levels), buffer_(levels + 1), power_(levels) {
    for (std::size_t j = 0; j <= levels; j = next_of(j)) {
      buffer_[j].assign(3 * (std::size_t{1} << j) + kBlock, 0.0);
    }
  }

  /// Takes samples start .. start + count - 1.
  void push(const double* samples, std::size_t start, std::size_t count, double pivot) {
    if (levels_ == 0) {
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      buffer_[0][3 + i] = samples[i] - pivot;
    }
    for (std::size_t j = 0; j < levels_; j = next_of(j)) {
      const std::size_t m = std::size_t{1} << j;
      const std::size_t after = next_of(j);
      double* const past = buffer_[j].data();
      double* const next = buffer_[after].data() + (std::size_t{3} << after);
      const std::array<std::size_t, 2> first{ready(start, 2 * m, count), ready(start, 4 * m, count)};
      if (after == j + 2) {
        std::array<double, 2> sum{};
        kernels().pyramid_pair(past + 3 * m, m, next, first.data(), count, sum.data());
        power_[j].add(sum[0]);
        power_[j + 1].add(sum[1]);
      } else {
        power_[j].add(kernels().pyramid_step(past + 3 * m, m, next, first[0], count));
      }
      std::memmove(past, past + count, 3 * m * sizeof(double));
    }
  }

  [[nodiscard]] double power(std::size_t level) const { return power_[level].value(); }

 private:
  /// The level that the step from level j ends at: two on, one where only one is left.
  [[nodiscard]] std::size_t next_of(std::size_t j) const { return j + 1 == levels_ ? j + 1 : j + 2; }
  /// First index in a block with a whole filter of `length` samples behind it.
  static std::size_t ready(std::size_t start, std::size_t length, std::size_t count) {
    return start + 1 >= length ? 0 : std::min(length - 1 - start, count);
  }
  std::size_t levels_;
  std::vector<std::vector<double>> buffer_;
  std::vector<CompensatedSum> power_;
};

/// Prefix sums of the recent past in one piece, and those of any earlier block made again from its samples: memory does
/// not grow with the record but for two numbers a block.
class PrefixHistory {
 public:
  PrefixHistory(std::span<const double> samples, double pivot)
      : samples_(samples),
        pivot_(pivot),
        // Not initialised: every element is written before it is read, and touching the array twice would show.
        window_(std::make_unique_for_overwrite<double[]>(std::min(samples.size(), kWindow) + kBlock + 1)) {
    window_[0] = 0.0;
    marks_.reserve(samples.size() / kBlock + 2);
  }

  /// Takes the block that starts at sample `start`; `[i]` of the result is the sum of start + i + 1 samples, and the
  /// kNearPast values in front of it are there.
  const double* push(std::size_t start, std::size_t count) {
    marks_.push_back({base_, carry_});
    if (end_ + count > kWindow) {
      std::memmove(window_.get(), window_.get() + (end_ - kNearPast), (kNearPast + 1) * sizeof(double));
      end_ = kNearPast;
    }
    double* const out = window_.get() + end_ + 1;
    extend_prefix(samples_.subspan(start, count), pivot_, base_, carry_, out);
    end_ += count;
    return out;
  }

  /// The block that starts at sample `start`, a multiple of kBlock, once more.
  void rebuild(std::size_t start, std::span<double> out) const {
    Mark mark = marks_[start / kBlock];
    extend_prefix(samples_.subspan(start, kBlock), pivot_, mark.base, mark.carry, out.data());
  }

  /// The sum of the first `t` samples, a multiple of kBlock.
  [[nodiscard]] double at(std::size_t t) const { return marks_[t / kBlock].base; }

  /// So far back a filter reaches in the window; beyond, blocks are made again.
  static constexpr std::size_t kNearPast = std::size_t{1} << 18U;

 private:
  static constexpr std::size_t kWindow = std::size_t{1} << 20U;
  struct Mark {
    double base;
    double carry;
  };
  std::span<const double> samples_;
  double pivot_;
  std::unique_ptr<double[]> window_;
  std::size_t end_ = 0;  ///< index of the newest sum
  double base_ = 0.0;
  double carry_ = 0.0;
  std::vector<Mark> marks_;
};

/// Adds the squares of the long filters that end in this block and lie in the window. `now`: its prefix sums.
void near_scales(const double* now, std::size_t start, std::size_t count, std::span<const std::size_t> half,
                 std::span<CompensatedSum> power) {
  std::size_t whole = 0;  // levels whose filter fits before every end of the block
  while (whole < half.size() && 2 * half[whole] <= start + 1) {
    ++whole;
  }
  std::array<double, 64> sum{};
  if (whole > 0) {
    kernels().octave_powers(now, half[0], whole, count, sum.data());
  }
  for (std::size_t j = whole; j < half.size() && 2 * half[j] <= start + count; ++j) {
    const std::size_t skipped = 2 * half[j] - start - 1;
    kernels().octave_powers(now + skipped, half[j], 1, count - skipped, &sum[j]);
  }
  for (std::size_t j = 0; j < half.size(); ++j) {
    power[j].add(sum[j]);
  }
}

/// The same for filters that reach further back than the window. Their half lengths are multiples of the block, so the
/// sums m and 2m samples ago are whole blocks, the second of one level being the first of the next.
void far_scales(const PrefixHistory& history, const double* now, std::size_t start, std::size_t count,
                std::span<const std::size_t> half, std::span<CompensatedSum> power) {
  std::array<std::array<double, kBlock>, 2> rebuilt;  // NOLINT: written before it is read
  const double* middle = half.empty() || start < half[0] ? nullptr : now - half[0];
  for (std::size_t j = 0; j < half.size(); ++j) {
    const std::size_t m = half[j];
    if (start >= 2 * m) {
      std::array<double, kBlock>& block = rebuilt[j % 2];
      history.rebuild(start - 2 * m, block);
      power[j].add(kernels().second_difference_power(now, middle, block.data(), count));
      middle = block.data();
    } else {
      if (start + count >= 2 * m) {  // the first filter of all ends with this block
        const double d = (now[count - 1] - history.at(m)) - history.at(m);
        power[j].add(d * d);
      }
      break;
    }
  }
}

constexpr std::size_t kPollBlocks = 256;

}  // namespace

HaarVariance haar_variance(std::span<const double> samples, double pivot, const RunControl& control) {
  HaarVariance result;
  const std::size_t n = samples.size();
  result.samples = n;
  std::size_t short_levels = 0;
  std::size_t near_end = 0;
  for (std::size_t m = 1; 2 * m <= n; m *= 2) {
    result.half.push_back(m);
    short_levels += m < kPyramidEnd ? 1 : 0;
    near_end += 2 * m <= PrefixHistory::kNearPast ? 1 : 0;
  }
  const std::size_t levels = result.half.size();
  Pyramid pyramid(short_levels);
  std::vector<CompensatedSum> power(levels);
  const std::span<const std::size_t> half(result.half);
  const std::span<CompensatedSum> sums(power);
  PrefixHistory history(levels > short_levels ? samples : samples.first(0), pivot);
  std::size_t blocks = 0;
  for (std::size_t start = 0; start < n; start += kBlock) {
    if (++blocks % kPollBlocks == 0 && control.stop.stop_requested()) {
      return {};
    }
    const std::size_t count = std::min(kBlock, n - start);
    pyramid.push(samples.data() + start, start, count, pivot);
    if (levels == short_levels) {
      continue;
    }
    const double* const now = history.push(start, count);
    near_scales(now, start, count, half.subspan(short_levels, near_end - short_levels),
                sums.subspan(short_levels, near_end - short_levels));
    far_scales(history, now, start, count, half.subspan(near_end), sums.subspan(near_end));
  }
  for (std::size_t j = 0; j < levels; ++j) {
    const double m = static_cast<double>(result.half[j]);
    const double total = j < short_levels ? pyramid.power(j) : power[j].value();
    result.variance.push_back(total / (4.0 * m * m) / static_cast<double>(result.coefficients(j)));
  }
  return result;
}

}  // namespace driftlab
