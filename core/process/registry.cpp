#include "core/process/registry.hpp"

#include "core/process/decimation.hpp"
#include "core/process/flicker_noise.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/linear_drift.hpp"
#include "core/process/low_pass_1.hpp"
#include "core/process/low_pass_2.hpp"
#include "core/process/moving_average.hpp"
#include "core/process/power_law.hpp"
#include "core/process/process_kind.hpp"
#include "core/process/quantization_noise.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/resonance.hpp"
#include "core/process/sinusoid.hpp"
#include "core/process/white_noise.hpp"

namespace driftlab {

const std::vector<ProcessKind>& process_registry() {
  static const std::vector<ProcessKind> all_kinds{
      kind_of<QuantizationNoise>(), kind_of<WhiteNoise>(),  kind_of<FlickerNoise>(),  kind_of<GaussMarkov>(),
      kind_of<RandomWalk>(),        kind_of<LinearDrift>(), kind_of<Sinusoid>(),      kind_of<Resonance>(),
      kind_of<LowPass1>(),          kind_of<LowPass2>(),    kind_of<MovingAverage>(), kind_of<Decimation>(),
      kind_of<PowerLaw>(),
  };
  return all_kinds;
}

const ProcessKind* find_process(std::string_view name_or_symbol) {
  for (const ProcessKind& kind : process_registry()) {
    if (kind.name == name_or_symbol || kind.symbol == name_or_symbol) {
      return &kind;
    }
  }
  return nullptr;
}

std::size_t registry_index(const ProcessKind* kind) {
  return static_cast<std::size_t>(kind - process_registry().data());
}

}  // namespace driftlab
