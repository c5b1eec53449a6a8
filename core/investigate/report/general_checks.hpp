#pragma once
/// The checks that test for no particular cause: statistics of the innovations, compared with their law under a right
/// model.
///
/// Per recording: variance over sixteen segments; correlation of one-second means (Ljung and Box 1978); spectrum in
/// sixteen bands; wavelet variance per scale; kurtosis. Per channel: the level that its recordings keep. Under the
/// model they are chi-square or normal, with as many degrees of freedom as segments, lags, bands, coefficients or
/// recordings were used. The kurtosis is not that of a Gaussian where the model itself holds uniform noise: rounding to
/// a lattice and quantization noise make it negative, by an amount that follows from their shares.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/report/report.hpp"

#include <limits>
#include <vector>

namespace driftlab::investigate {

struct InnovationMoments {
  double count = 0.0, mean_square = 0.0, kurtosis = 0.0;  ///< kurtosis: the excess over 3
};

/// Moments about zero of the samples in use; gross values are cut at `cut`.
[[nodiscard]] InnovationMoments moments_of(const Series& innovations, const std::vector<unsigned char>& used,
                                           double cut = std::numeric_limits<double>::infinity());

/// Adds the checks of one channel; a recording with fewer than 500 samples in use has none. `p` is not adjusted.
void general_checks(const ChannelGroup& group, const FullRate& data, std::vector<Check>& checks);

}  // namespace driftlab::investigate
