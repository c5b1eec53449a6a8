#pragma once
/// When each row of a stored recording was taken, as far as its survey tells.
///
/// A survey keeps the mean rate of the rows, the number of samples that gaps lack, and the longest gaps one by one. A
/// told gap stands where it is; what the others take is spread over the rows. Where all gaps are told, the rows between
/// them have the interval of the samples.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

class RowClock {
 public:
  /// `rows` rows at `rate_hz` [1/s] from the first to the last, `missing` samples in all gaps, `told` some of these in
  /// order of their rows. Without gaps row k is at k / rate_hz.
  RowClock(double rate_hz, std::size_t rows, std::size_t missing, std::vector<Gap> told);

  /// Of the rows between the gaps that are told [1/s].
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  /// When a row begins [s after the first].
  [[nodiscard]] double begin_of(std::size_t row) const { return at(row, lost_before(row + 1)); }
  /// When the row before `row` ends, which is where a gap before `row` begins.
  [[nodiscard]] double end_before(std::size_t row) const { return at(row, lost_before(row)); }
  /// The row that is on at `time_s`; in a gap the row behind it. Not above `rows`.
  [[nodiscard]] std::size_t row_at(double time_s) const;

 private:
  [[nodiscard]] double at(std::size_t row, double lost_s) const { return static_cast<double>(row) / rate_hz_ + lost_s; }
  /// Seconds in gaps before rows below `row`.
  [[nodiscard]] double lost_before(std::size_t row) const;
  [[nodiscard]] double seconds(const Gap& gap) const { return static_cast<double>(gap.missing) / sample_rate_hz_; }

  std::size_t rows_;
  std::vector<Gap> told_;
  double rate_hz_;
  double sample_rate_hz_;
};

}  // namespace driftlab
