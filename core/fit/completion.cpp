#include "core/fit/completion.hpp"

#include "core/fit/completion_past.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

using namespace completion;

constexpr std::size_t kBlock = 2048;
constexpr std::size_t kTable = 1024;
constexpr double kTableEnd = 8.0;

/// Decides about samples and draws them.
class Judge {
 public:
  Judge(const CompletionLaw& law, Random& random) : law_(law), random_(random), looks_(!law.mixture.ratio.empty()) {
    for (std::size_t i = 0; looks_ && i <= kTable; ++i) {
      chance_[i] = law.mixture.posterior(kTableEnd * static_cast<double>(i) / kTable);
    }
  }

  /// The good sample behind `y`, whose law without it is `predicted`; sets its state and residual.
  double judge(double y, const Predicted& predicted, std::uint8_t& state, double& magnitude) {
    const double error = y - predicted.mean;
    magnitude = std::fabs(error) / std::sqrt(predicted.variance);
    state = kGoodSample;
    if (!looks_ || random_.uniform() >= chance(magnitude)) {
      return y;
    }
    const std::size_t size = law_.mixture.pick_size(magnitude, random_.uniform());
    state = static_cast<std::uint8_t>(size + 1);
    const double good = law_.mixture.core * predicted.variance;
    const double gross = law_.mixture.ratio[size] * law_.unit;
    const double share = good / (good + gross);
    return predicted.mean + share * error + std::sqrt(share * gross) * random_.normal();
  }

  double draw(const Predicted& predicted) {
    return predicted.mean + std::sqrt(law_.mixture.core * predicted.variance) * random_.normal();
  }

 private:
  [[nodiscard]] double chance(double magnitude) const {
    if (std::isnan(magnitude)) {
      return 0.0;  // numbers near the end of what a double holds: nothing can be said of the sample
    }
    if (magnitude >= kTableEnd) {
      return law_.mixture.posterior(magnitude);
    }
    const double at = magnitude * (kTable / kTableEnd);
    const auto cell = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(cell);
    return chance_[cell] + part * (chance_[cell + 1] - chance_[cell]);
  }

  const CompletionLaw& law_;
  Random& random_;
  bool looks_;
  std::array<double, kTable + 1> chance_{};
};

template <int N, bool Quantized>
void sweep(const CompletionLaw& law, const CompletionArrays& arrays, Random& random, ResidualHistogram& histogram,
           const RunControl& control) {
  const std::size_t samples = arrays.recorded.size();
  const Chain<N, Quantized> chain(law, samples);
  const std::size_t blocks = (samples + kBlock - 1) / kBlock;
  std::vector<Information<N>> at_end(blocks);  // information in samples after the block
  Information<N> information;
  for (std::size_t block = blocks; block-- > 0;) {
    if (control.stop.stop_requested()) {
      return;
    }
    at_end[block] = information;
    for (std::size_t t = std::min(samples, (block + 1) * kBlock); t-- > block * kBlock && block > 0;) {
      chain.back(information, arrays.recorded[t] - law.pivot, arrays.state[t]);
    }
  }
  Past<N, Quantized> past(chain);
  Judge judge(law, random);
  std::vector<Information<N>> later(kBlock);
  for (std::size_t block = 0; block < blocks; ++block) {
    if (control.stop.stop_requested()) {
      return;
    }
    const std::size_t first = block * kBlock;
    const std::size_t last = std::min(samples, first + kBlock);
    information = at_end[block];
    for (std::size_t t = last; t-- > first;) {
      later[t - first] = information;
      chain.back(information, arrays.recorded[t] - law.pivot, arrays.state[t]);
    }
    for (std::size_t t = first; t < last; ++t) {
      const Predicted predicted = past.predict(later[t - first]);
      double sample = 0.0;
      double magnitude = 0.0;
      if (arrays.state[t] == kAbsentSample) {
        sample = judge.draw(predicted);
      } else {
        sample = judge.judge(arrays.recorded[t] - law.pivot, predicted, arrays.state[t], magnitude);
        histogram.add(magnitude);
      }
      arrays.completed[t] = arrays.state[t] == kGoodSample ? arrays.recorded[t] : sample + law.pivot;
      if (!arrays.residual.empty()) {
        arrays.residual[t] = static_cast<float>(magnitude);
      }
      past.advance(sample);
    }
  }
}

}  // namespace

void sweep_completion(const CompletionLaw& law, const CompletionArrays& arrays, Random& random,
                      ResidualHistogram& histogram, const RunControl& control) {
  switch (law.states.count * 2 + (law.states.quantization ? 1 : 0)) {
    case 2:
      return sweep<1, false>(law, arrays, random, histogram, control);
    case 4:
      return sweep<2, false>(law, arrays, random, histogram, control);
    case 5:
      return sweep<2, true>(law, arrays, random, histogram, control);
    case 6:
      return sweep<3, false>(law, arrays, random, histogram, control);
    case 7:
      return sweep<3, true>(law, arrays, random, histogram, control);
    case 8:
      return sweep<4, false>(law, arrays, random, histogram, control);
    case 9:
      return sweep<4, true>(law, arrays, random, histogram, control);
    default:
      return;
  }
}

}  // namespace driftlab
