#pragma once
/// The description of a channel's curve: the composite model that a stepwise search finds, and the coefficients of IEEE
/// Std 952 that follow from it.
///
/// The curve is taken on four scales to the octave from the samples themselves. Where gross errors call for robust
/// variances, or samples are missing, the octaves serve for which these exist.
#include "core/fit/channel_variances.hpp"
#include "core/fit/characterisation.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>

namespace driftlab {

/// A channel whose octaves are known.
struct DescribedSamples {
  std::span<const double> samples;  ///< without gaps
  double mean = 0.0;
  double dt_s = 0.0;
  double unit = 1.0;                  ///< SI units in a sample's unit
  double unit_square = 1.0;           ///< sample units^2 in the unit of the octaves' variances
  std::span<const std::size_t> half;  ///< half lengths of the octaves
  bool gaps = false;                  ///< `samples` were completed
};

/// Fills in `description` and `allan_parameters`. Fewer than five scales give reasons only. A requested stop leaves the
/// result unfinished.
void describe_curve(const DescribedSamples& channel, const FittedVariances& octaves, const RunControl& control,
                    ChannelCharacterisation& result);

}  // namespace driftlab
