#include "core/investigate/causes/draft.hpp"

namespace driftlab::investigate {

void inject(const Cause& cause, Draft& draft, std::span<const double> values, Random& random) {
  if (values.size() < cause.parameters.size()) {
    return;
  }
  if (cause.inject != nullptr) {
    cause.inject(draft, values, random);
    return;
  }
  if (const SlowNoise* const slow = cause.as<SlowNoise>()) {
    const auto own = values.first(slow->kind->parameters.size());
    Process{slow->kind, {own.begin(), own.end()}}.add_path(random, draft.recording->dt_s, draft.slow);
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
