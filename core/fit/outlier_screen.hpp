#pragma once
/// A first look for gross errors, before there is any model: where to start completion.hpp from.
///
/// Residuals from five local predictors (mean of the two neighbours; medians of the four neighbours and of windows of
/// 15, 63 and 251 samples); the one of the smallest median absolute deviation is used. A sample further out than 5
/// robust standard deviations is suspect. A patch is a window of 8 or 20 samples whose mean clipped residual from the
/// longest median is further out than 5.5 robust standard deviations of such means. Medians of w samples are taken at
/// every w/4-th and interpolated between.
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

/// `samples`: at least 1; missing ones left out by the caller. O(N), about 100 ns a sample. No
/// residuals where `control.stop` asked.
[[nodiscard]] OutlierScreen screen_outliers(std::span<const double> samples, const RunControl& control = {});

}  // namespace driftlab
