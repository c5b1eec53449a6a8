#pragma once
/// Screening for gross errors without a model; it gives the starting point of completion.hpp.
///
/// Residuals are formed from five local predictors: the mean of the two neighbours, the median of the four neighbours,
/// and the medians of windows of 15, 63 and 251 samples. The predictor with the smallest median absolute deviation is
/// used. A sample further out than 5 robust standard deviations is suspect. A patch is a window of 8 or 20 samples
/// whose mean clipped residual from the longest median is further out than 5.5 robust standard deviations of such
/// means. Medians of w samples are computed at every w/4-th sample and interpolated between.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace driftlab {

struct OutlierScreen {
  std::vector<float> residual;      ///< in robust standard deviations, one per sample
  std::vector<std::uint8_t> patch;  ///< one per sample: 1 inside a patch
  double sd = 0.0;                  ///< robust standard deviation of the residuals; 0: more than half are equal
};

/// `samples` holds at least 1 sample; the caller leaves missing ones out. O(N), about 100 ns a sample. The result has
/// no residuals if a stop was requested through `control.stop`.
[[nodiscard]] OutlierScreen screen_outliers(std::span<const double> samples, const RunControl& control = {});

}  // namespace driftlab
