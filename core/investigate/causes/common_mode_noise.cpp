/// common_mode_noise: equal pairwise correlation of the white parts of the axes.
/// The pooled correlation r of the innovations has variance 1/(pairs samples) under independence; the white parts' is
/// r / rho.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Log likelihood gained by equal correlation r of the axes over independence, on one half of every recording:
/// -1/2 sum [ ln((1-r)^(k-1) (1+(k-1) r)) + (S2 - r S^2/(1+(k-1) r))/(1-r) - S2 ], S2 the sum of squares, S the sum.
double gain_on(std::span<const FullRate> axes, double r, std::size_t half) {
  const auto k = static_cast<double>(axes.size());
  const double log_det = (k - 1.0) * std::log1p(-r) + std::log1p((k - 1.0) * r);
  double gain = 0.0;
  for (std::size_t m = 0; m < axes[0].members(); ++m) {
    std::size_t n = axes[0].innovation[m].size();
    for (const FullRate& axis : axes) {
      n = m < axis.members() ? std::min(n, axis.innovation[m].size()) : 0;
    }
    for (std::size_t i = half * n / 2; i < (half + 1) * n / 2; ++i) {
      double sum = 0.0;
      double square = 0.0;
      bool used = true;
      for (const FullRate& axis : axes) {
        used = used && axis.used[m][i] != 0;
        sum += axis.innovation[m][i];
        square += axis.innovation[m][i] * axis.innovation[m][i];
      }
      if (used) {
        gain -= 0.5 * (log_det + (square - r * sum * sum / (1.0 + (k - 1.0) * r)) / (1.0 - r) - square);
      }
    }
  }
  return gain;
}

/// Pooled correlation on one half.
double correlation_on(std::span<const FullRate> axes, std::size_t half) {
  double cross = 0.0;
  double square = 0.0;
  for (std::size_t m = 0; m < axes[0].members(); ++m) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      for (std::size_t b = a + 1; b < axes.size(); ++b) {
        if (m >= axes[b].members() || m >= axes[a].members()) {
          continue;
        }
        const auto& x = axes[a].innovation[m];
        const auto& y = axes[b].innovation[m];
        const std::size_t n = std::min(x.size(), y.size());
        for (std::size_t i = half * n / 2; i < (half + 1) * n / 2; ++i) {
          cross += x[i] * y[i];
          square += 0.5 * (x[i] * x[i] + y[i] * y[i]);
        }
      }
    }
  }
  return square > 0.0 ? std::clamp(cross / square, 0.0, 0.95) : 0.0;
}

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
  for (std::size_t half = 0; half < 2; ++half) {
    evidence.heldout_gain += gain_on(axes, correlation_on(axes, 1 - half), half);
  }
  for (const auto& e : axes[0].innovation) {
    evidence.heldout_samples += static_cast<double>(e.size()) * static_cast<double>(axes.size());
  }
  evidence.heldout = true;
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

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {stage.z / std::sqrt(3.0 * stage.samples())};
}

}  // namespace

Cause common_mode_noise() {
  return {.name = "common_mode_noise",
          .title = "noise that the axes share",
          .equation = "E(e₁ e₂) = correlation · s₁ s₂ for any two axes, e the white part and s its standard deviation",
          .family = CommonNoise{.examine_together = examine},
          .rivals = {},
          .needs = "several axes recorded together",
          .separates = "",
          .parameters = {{"correlation", units::one}},
          .lacks = lacks_axes,
          .inject = inject_effect,
          .showing = {.scenario = Scenario::Axes, .values = shown_values}};
}

}  // namespace driftlab::investigate
