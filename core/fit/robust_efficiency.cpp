#include "core/fit/robust_efficiency.hpp"

namespace driftlab {

std::optional<double> mean_robust_efficiency(const HaarCurve& curve) {
  double sum = 0.0;
  int defined = 0;
  for (std::size_t i = 0; i < curve.robust_variance.size(); ++i) {
    sum += curve.robust_variance[i] ? curve.robust_efficiency[i] : 0.0;
    defined += curve.robust_variance[i] ? 1 : 0;
  }
  return defined > 0 ? std::optional(sum / defined) : std::nullopt;
}

}  // namespace driftlab
