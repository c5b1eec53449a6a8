#include "core/analysis/row_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {

RowClock::RowClock(double rate_hz, std::size_t rows, std::size_t missing, std::vector<Gap> told)
    : rows_(rows), told_(std::move(told)), rate_hz_(rate_hz), sample_rate_hz_(rate_hz) {
  if (told_.empty() || rows < 2) {
    return;
  }
  std::size_t told_missing = 0;
  for (const Gap& gap : told_) {
    told_missing += gap.missing;
  }
  const auto steps = static_cast<double>(rows - 1);
  const double time_s = steps / rate_hz;
  sample_rate_hz_ = (steps + static_cast<double>(std::max(missing, told_missing))) / time_s;
  rate_hz_ = steps / (time_s - static_cast<double>(told_missing) / sample_rate_hz_);
}

double RowClock::lost_before(std::size_t row) const {
  double lost = 0.0;
  for (const Gap& gap : told_) {
    if (gap.row >= row) {
      break;
    }
    lost += seconds(gap);
  }
  return lost;
}

std::size_t RowClock::row_at(double time_s) const {
  const auto row_after = [&](double lost) {
    return static_cast<std::size_t>(
        std::clamp(std::floor((time_s - lost) * rate_hz_), 0.0, static_cast<double>(rows_)));
  };
  double lost = 0.0;
  std::size_t row = row_after(lost);
  for (const Gap& gap : told_) {
    if (row < gap.row) {
      break;
    }
    lost += seconds(gap);
    row = std::max(gap.row, row_after(lost));
  }
  return row;
}

}  // namespace driftlab
