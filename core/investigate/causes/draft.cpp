#include "core/investigate/causes/draft.hpp"

#include "core/process/flicker_noise.hpp"

#include <cmath>

namespace driftlab::investigate {

void add_slow(SlowKind kind, double level, double beta, double dt_s, Random& random, std::vector<double>& out) {
  switch (kind) {
    case SlowKind::GaussMarkov: {
      const double phi = std::exp(-beta * dt_s);
      const double step = std::sqrt(-level * std::expm1(-2.0 * beta * dt_s));
      double x = std::sqrt(level) * random.normal();
      for (double& v : out) {
        v += x;
        x = phi * x + step * random.normal();
      }
      break;
    }
    case SlowKind::RandomWalk: {
      const double step = std::sqrt(level * dt_s);
      double x = 0.0;
      for (double& v : out) {
        v += x;
        x += step * random.normal();
      }
      break;
    }
    case SlowKind::Flicker:
      FlickerNoise{std::sqrt(level)}.add_path(random, dt_s, out);
      break;
    case SlowKind::Offset: {
      const double x = std::sqrt(level) * random.normal();
      for (double& v : out) {
        v += x;
      }
      break;
    }
  }
}

void inject(const Cause& cause, Draft& draft, std::span<const double> values, Random& random) {
  if (values.size() < cause.parameters.size()) {
    return;
  }
  if (cause.inject != nullptr) {
    cause.inject(draft, values, random);
    return;
  }
  if (const SlowNoise* const slow = cause.as<SlowNoise>()) {
    add_slow(slow->kind, values[0] * values[0], values.size() > 1 ? values[1] : 0.0, draft.recording->dt_s, random,
             draft.slow);
    return;
  }
  if (const MeanEffect* const mean = cause.as<MeanEffect>()) {
    std::vector<std::vector<double>> columns;
    const double shape = values.size() > 1 ? values[1] : 0.0;
    if (mean->build(*draft.recording, *draft.group, shape, columns)) {
      for (std::size_t i = 0; i < draft.mean.size(); ++i) {
        draft.mean[i] += values[0] * columns[0][i];
      }
    }
  }
}

}  // namespace driftlab::investigate
