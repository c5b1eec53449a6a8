#pragma once
/// Samples that come in blocks, each with the time of its first sample: the logs of wearable accelerometers. Internal
/// to core/read.
///
/// The clock that stamps the blocks and the sensor that fills them are two; the time between two stamps is shared out
/// evenly among the samples between them, so that the true rate is delivered and no sample is moved. Where two stamps
/// are more than a tenth off what the samples between them should take (blocks are lost, the clock was set), and behind
/// the last stamp, samples go at the stated rate: a gap stays a gap. Times count from the first block.
#include "core/read/format.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

class StampedBlocks {
 public:
  /// `width`: values of a sample, without its time.
  StampedBlocks(ColumnSink& sink, std::size_t width) : sink_(sink), width_(width) {}

  /// A block of whole samples that starts `start_s` seconds behind any fixed moment, at a stated `step_s` > 0.
  [[nodiscard]] Status take(double start_s, double step_s, std::span<const double> values) {
    if (values.empty()) {
      return {};
    }
    const bool first = waiting_.empty() && !started_;
    zero_s_ = first ? start_s : zero_s_;
    started_ = true;
    if (auto status = deliver(start_s); !status) {
      return status;
    }
    start_s_ = start_s;
    step_s_ = step_s;
    waiting_.assign(values.begin(), values.end());
    return {};
  }

  /// Delivers the last block.
  [[nodiscard]] Status finish() { return deliver(start_s_ + count() * step_s_); }

  [[nodiscard]] bool empty() const { return !started_; }

 private:
  [[nodiscard]] double count() const { return static_cast<double>(waiting_.size()) / static_cast<double>(width_); }

  /// Delivers the waiting block, now that the start of the next one is known.
  [[nodiscard]] Status deliver(double next_s) {
    if (waiting_.empty()) {
      return {};
    }
    const double measured_s = (next_s - start_s_) / count();
    const double step_s = std::abs(measured_s / step_s_ - 1.0) <= 0.1 ? measured_s : step_s_;
    rows_.clear();
    for (std::size_t row = 0; row * width_ < waiting_.size(); ++row) {
      const std::size_t at = row * width_;
      rows_.push_back(start_s_ - zero_s_ + static_cast<double>(row) * step_s);
      rows_.insert(rows_.end(), waiting_.begin() + static_cast<std::ptrdiff_t>(at),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(at + width_));
    }
    return sink_.rows(rows_);
  }

  ColumnSink& sink_;
  std::size_t width_;
  bool started_ = false;
  double zero_s_ = 0.0;
  double start_s_ = 0.0;
  double step_s_ = 0.0;
  std::vector<double> waiting_;
  std::vector<double> rows_;
};

}  // namespace driftlab
