#pragma once
/// The distribution of the innovations: Gaussian, Student-t, or Gaussian with gross errors.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/signal/estimate.hpp"

#include <functional>

namespace driftlab::investigate {

/// Counts of |e| in bins of 0.05 up to 12; what lies beyond, one by one (cut at 1000).
struct InnovationHistogram {
  std::vector<double> centre, count;
  double samples = 0.0;
  double square = 0.0;  ///< sum of e^2
};
/// `own_levels`: each recording over its own root mean square (gross values cut at five) times that of all. Levels that
/// differ from recording to recording, all of them Gaussian, would together look like heavy tails.
[[nodiscard]] InnovationHistogram histogram_of(const FullRate& data, bool own_levels);

struct TailFit {
  double value = 0.0;  ///< 1/nu of the innovations; 0: Gaussian
  Interval interval;
  double gain = 0.0;             ///< over the Gaussian of the baseline's scale (of free scale, where that is free)
  double gain_free_scale = 0.0;  ///< over the Gaussian of free scale
};
/// Student-t of unit variance times a scale (free unless `scale_known`).
[[nodiscard]] TailFit fit_student(const InnovationHistogram& histogram, bool scale_known);

struct MixtureFit {
  double fraction = 0.0;
  double magnitude = 0.0;  ///< in standard deviations
  Interval fraction_interval, magnitude_interval;
  double gain = 0.0;
  double gain_free_scale = 0.0;
};
[[nodiscard]] MixtureFit fit_mixture(const InnovationHistogram& histogram, bool scale_known);

/// Log likelihood that tails found elsewhere gain over a Gaussian here; the scale is this histogram's own unless known.
[[nodiscard]] double student_gain(const InnovationHistogram& histogram, double inverse_nu, bool scale_known);
[[nodiscard]] double mixture_gain(const InnovationHistogram& histogram, double fraction, double magnitude,
                                  bool scale_known);

/// Replaces each innovation by the normal quantile of its place in a symmetric distribution, which is given by the
/// probability of exceeding e >= 0 on one side. The results are standard normal if that distribution is right.
void to_normal_scores(FullRate& data, const std::function<double(double)>& tail);

}  // namespace driftlab::investigate
