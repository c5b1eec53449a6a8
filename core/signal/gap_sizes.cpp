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

/// Estimates what is missing at each of several jumps, from what is taken to be missing at the others.
class Jumps {
 public:
  Jumps(std::span<const double> stamps, std::span<const std::size_t> jumps, std::span<const std::size_t> backward,
        double interval_s)
      : stamps_(stamps), jumps_(jumps), backward_(backward), interval_(interval_s), missing_(jumps.size(), 0.0) {}

  /// Each in turn, by the rows up to the next jump or by all within reach. Returns whether any has changed.
  bool estimate(bool up_to_next) {
    bool changed = false;
    for (std::size_t jump = 0; jump < jumps_.size(); ++jump) {
      const double found = missing_at(jump, up_to_next);
      changed = changed || found != missing_[jump];
      missing_[jump] = found;
    }
    return changed;
  }

  [[nodiscard]] std::vector<Gap> gaps() const {
    constexpr double kMost = 0.5 * static_cast<double>(std::numeric_limits<std::uint32_t>::max());
    std::vector<Gap> gaps;
    for (std::size_t jump = 0; jump < jumps_.size(); ++jump) {
      if (missing_[jump] >= 1.0) {
        gaps.push_back({jumps_[jump], static_cast<std::size_t>(std::min(missing_[jump], kMost))});
      }
    }
    return gaps;
  }

 private:
  [[nodiscard]] double missing_at(std::size_t jump, bool up_to_next) const {
    const std::size_t row = jumps_[jump];
    const auto behind = std::upper_bound(backward_.begin(), backward_.end(), row);
    const std::size_t part_end = behind == backward_.end() ? stamps_.size() : *behind;
    const std::size_t part_begin = behind == backward_.begin() ? 0 : *(behind - 1);
    if (row == part_begin) {
      return 0.0;  // the clock was set here
    }
    // Stamp minus place, both counted from this row and in intervals; places as if nothing were missing here.
    const auto offset = [&](std::size_t i) {
      return (stamps_[i] - stamps_[row]) / interval_ - (static_cast<double>(i) - static_cast<double>(row));
    };
    Median before;
    double lost = 0.0;
    std::size_t other = jump;
    for (std::size_t i = row; i-- > row - std::min(kReach, row - part_begin);) {
      for (; other > 0 && jumps_[other - 1] > i; --other) {
        lost += missing_[other - 1];
      }
      before.take(offset(i) + lost);
    }
    Median after;
    lost = 0.0;
    other = jump + 1;
    for (std::size_t i = row; i < std::min(row + kReach, part_end); ++i) {
      if (other < jumps_.size() && jumps_[other] == i) {
        if (up_to_next) {
          break;
        }
        lost += missing_[other++];
      }
      after.take(offset(i) - lost);
    }
    return std::max(0.0, std::round(after.value() - before.value()));
  }

  std::span<const double> stamps_;
  std::span<const std::size_t> jumps_;
  std::span<const std::size_t> backward_;
  double interval_;
  std::vector<double> missing_;
};

}  // namespace

std::vector<Gap> gap_sizes(std::span<const double> stamps, std::span<const std::size_t> jumps,
                           std::span<const std::size_t> backward, double interval_s) {
  constexpr int kMostRounds = 8;  // near jumps settle in one or two
  Jumps sizes(stamps, jumps, backward, interval_s);
  (void)sizes.estimate(true);
  for (int round = 0; round < kMostRounds && sizes.estimate(false); ++round) {
  }
  return sizes.gaps();
}

}  // namespace driftlab
