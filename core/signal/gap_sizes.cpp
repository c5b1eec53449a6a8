#include "core/signal/gap_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace driftlab {
namespace {

constexpr std::size_t kReach = 32;

/// Middle of up to kReach numbers; the mean of the two middle ones of an even count.
class Median {
 public:
  void take(double value) { values_[count_++] = value; }
  [[nodiscard]] double value() {
    const auto begin = values_.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(count_);
    std::sort(begin, end);
    return 0.5 * (values_[(count_ - 1) / 2] + values_[count_ / 2]);
  }

 private:
  std::array<double, kReach> values_{};
  std::size_t count_ = 0;
};

/// Places of rows on the grid, known up to the last jump looked at: row plus all that is missing before it.
class Grid {
 public:
  explicit Grid(const std::vector<Gap>& gaps) : gaps_(gaps) {}
  /// Place of `row` less `row`, where `gaps` are all gaps up to it.
  [[nodiscard]] double shift(std::size_t row) const {
    double shift = 0.0;
    for (auto gap = gaps_.rbegin(); gap != gaps_.rend() && gap->row > row; ++gap) {
      shift -= static_cast<double>(gap->missing);
    }
    return shift;
  }

 private:
  const std::vector<Gap>& gaps_;
};

}  // namespace

std::vector<Gap> gap_sizes(std::span<const double> stamps, std::span<const std::size_t> jumps,
                           std::span<const std::size_t> backward, double interval_s) {
  std::vector<Gap> gaps;
  const Grid grid(gaps);
  for (const std::size_t row : jumps) {
    const auto behind = std::upper_bound(backward.begin(), backward.end(), row);
    const std::size_t part_end = behind == backward.end() ? stamps.size() : *behind;
    const std::size_t part_begin = behind == backward.begin() ? 0 : *(behind - 1);
    if (row == part_begin) {
      continue;  // the clock was set here
    }
    // Stamp minus place, both counted from this row and in intervals; places behind it as if nothing were missing.
    const auto offset = [&](std::size_t i, double shift) {
      return (stamps[i] - stamps[row]) / interval_s - (static_cast<double>(i) - static_cast<double>(row)) - shift;
    };
    Median before;
    for (std::size_t i = row - std::min(kReach, row - part_begin); i < row; ++i) {
      before.take(offset(i, grid.shift(i)));
    }
    Median after;
    for (std::size_t i = row; i < std::min(row + kReach, part_end); ++i) {
      after.take(offset(i, 0.0));
    }
    const double missing = std::round(after.value() - before.value());
    if (missing >= 1.0) {
      const double most = 0.5 * static_cast<double>(std::numeric_limits<std::uint32_t>::max());
      gaps.push_back({row, static_cast<std::size_t>(std::min(missing, most))});
    }
  }
  return gaps;
}

}  // namespace driftlab
