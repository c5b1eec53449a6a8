#pragma once
/// When rows of a recording were taken.
#include "core/signal/recording.hpp"

#include <cstddef>

namespace driftlab {

/// Time of each analysed row since the first row of the file [s]: by its place, and by what is missing before it.
class RowTimes {
 public:
  /// `window` must outlive this object.
  explicit RowTimes(const Window& window) : window_(window) {}

  /// Rows of the file, from 0; they must be asked for in rising order. O(1) each, and O(gaps) for all of them.
  [[nodiscard]] double at(std::size_t row) {
    for (; next_ < window_.gaps.size() && window_.gaps[next_].row <= row; ++next_) {
      missing_ += window_.gaps[next_].missing;
    }
    return window_.time.first_s + window_.time.dt_s * static_cast<double>(row - window_.first + missing_);
  }

 private:
  const Window& window_;
  std::size_t next_ = 0;
  std::size_t missing_ = 0;
};

}  // namespace driftlab
