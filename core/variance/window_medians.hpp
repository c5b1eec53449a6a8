#pragma once
/// Medians of many windows of one length, eight windows at a time.
///
/// A sorting network (Batcher's odd-even merge sort; Knuth, The Art of Computer Programming 3, algorithm 5.2.2M) orders
/// the same places of eight windows at once, without a branch. Exchanges on which the value in the middle does not
/// depend are left out: 15 values take 49 of 59, 251 take 3,143 of 3,773.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace driftlab {

class WindowMedians {
 public:
  /// `length`: samples of a window, odd, below 65,536.
  explicit WindowMedians(std::size_t length);

  /// out[k] = the median of samples[k stride] .. samples[k stride + length - 1], k < count. The values are numbers.
  void find(const double* samples, std::size_t stride, std::size_t count, double* out);

  /// Exchanges for a window.
  [[nodiscard]] std::size_t exchanges() const { return pairs_.size() / 2; }

 private:
  std::size_t length_;
  std::vector<std::uint16_t> pairs_;  ///< places, the lower value to the first
  std::vector<double> columns_;       ///< place by place, eight windows side by side
};

}  // namespace driftlab
