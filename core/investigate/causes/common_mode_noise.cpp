/// common_mode_noise: equal pairwise correlation of the white parts of the axes.
/// The pooled correlation r of the innovations has variance 1/(pairs samples) under independence; the white parts' is
/// r / rho.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/draft.hpp"
#include "core/investigate/full_rate.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> examine(std::span<const FullRate> axes) {
  if (axes.size() < 2) {
    return {};
  }
  double cross = 0.0;
  double count = 0.0;
  double share = 0.0;
  double worst = 1e300;
  double best = -1e300;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    share += axes[a].white_share / static_cast<double>(axes.size());
    for (std::size_t b = a + 1; b < axes.size(); ++b) {
      double pair = 0.0;
      double pair_count = 0.0;
      double aa = 0.0;
      double bb = 0.0;
      for (std::size_t r = 0; r < axes[a].members(); ++r) {
        for (std::size_t s = 0; s < axes[b].members(); ++s) {
          if (axes[a].group->members[r].recording != axes[b].group->members[s].recording) {
            continue;
          }
          const auto& x = axes[a].innovation[r];
          const auto& y = axes[b].innovation[s];
          for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
            if (axes[a].used[r][i] != 0 && axes[b].used[s][i] != 0) {
              const double u = std::clamp(x[i], -5.0, 5.0);
              const double v = std::clamp(y[i], -5.0, 5.0);
              pair += u * v;
              aa += u * u;
              bb += v * v;
              pair_count += 1.0;
            }
          }
        }
      }
      if (pair_count < 100.0) {
        return {};
      }
      pair /= std::sqrt(aa * bb);
      cross += pair * pair_count;
      count += pair_count;
      worst = std::min(worst, pair);
      best = std::max(best, pair);
    }
  }
  const double r = cross / count;
  Evidence evidence;
  evidence.members = all_members(*axes[0].group);
  evidence.gain = count * r * r;
  evidence.score = r > 0.0 ? evidence.gain - 1.0 : 0.0;
  // Equal correlation of k axes: log likelihood ratio per sample is -1/2 ln[(1 - r)^(k-1) (1 + (k-1) r)].
  const double sd = (1.0 - r) * (1.0 + (static_cast<double>(axes.size()) - 1.0) * r) / std::sqrt(count);
  evidence.shape = r;
  evidence.parameters = {{"correlation",
                          {r / share, {(r - 1.96 * sd) / share, (r + 1.96 * sd) / share}},
                          units::one(axes[0].group->unit)}};
  return {evidence};
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  double square = 0.0;
  for (const double v : draft.white) {
    square += v * v / static_cast<double>(draft.white.size());
  }
  for (std::size_t i = 0; i < draft.white.size(); ++i) {
    draft.white[i] = std::sqrt(1.0 - values[0]) * draft.white[i] + std::sqrt(values[0] * square) * draft.shared[i];
  }
}

}  // namespace

Cause common_mode_noise() {
  return {.name = "common_mode_noise",
          .title = "noise that the axes share",
          .family = Family::CommonMode,
          .rivals = {},
          .needs = "several axes recorded together",
          .separates = "",
          .parameters = {{"correlation", units::one}},
          .examine_together = examine,
          .inject = inject_effect};
}

}  // namespace driftlab::investigate
