#include "core/investigate/slow/profile.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

double profile_end(double centre, double step, double top, double drop, double limit,
                   const std::function<double(double)>& log_likelihood) {
  double inside = centre;
  double inside_root = 0.0;
  double outside = centre;
  double outside_root = 0.0;
  const double target = std::sqrt(drop);
  for (int i = 0; i < 12; ++i) {
    double x = centre + step;
    const bool stopped = step > 0.0 ? x >= limit : x <= limit;
    if (stopped) {
      x = limit;
    }
    const double root = std::sqrt(std::max(0.0, 2.0 * (top - log_likelihood(x))));
    if (root >= target) {
      outside = x;
      outside_root = root;
      break;
    }
    inside = x;
    inside_root = root;
    if (stopped) {
      return limit;
    }
    step *= root > 0.3 * target ? 1.2 * target / root : 2.0;
  }
  if (!(outside_root > 0.0)) {
    return inside;
  }
  for (int i = 0; i < 4; ++i) {  // the root of the deviance is nearly linear in x
    const double share = std::clamp((target - inside_root) / (outside_root - inside_root), 0.05, 0.95);
    const double x = inside + share * (outside - inside);
    const double root = std::sqrt(std::max(0.0, 2.0 * (top - log_likelihood(x))));
    if (std::fabs(root - target) < 0.02) {
      return x;
    }
    (root < target ? inside : outside) = x;
    (root < target ? inside_root : outside_root) = root;
  }
  return inside + (target - inside_root) / (outside_root - inside_root) * (outside - inside);
}

}  // namespace driftlab::investigate
