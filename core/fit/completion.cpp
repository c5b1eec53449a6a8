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
  [[gnu::always_inline]] double judge(double y, const Predicted& predicted, std::uint8_t& state, double& magnitude) {
    const double error = y - predicted.mean;
    if (predicted.variance != variance_) {
      variance_ = predicted.variance;
      sd_ = std::sqrt(variance_);
    }
    magnitude = std::fabs(error) / sd_;
    state = kGoodSample;
    if (!looks_ || random_.uniform() >= chance(magnitude)) {
      return y;
    }
    return replace(error, predicted, state, magnitude);
  }

  double draw(const Predicted& predicted) {
    return predicted.mean + std::sqrt(law_.mixture.core * predicted.variance) * random_.normal();
  }

 private:
  /// The good sample behind one that carries a gross error of a size that is drawn.
  [[gnu::noinline]] double replace(double error, const Predicted& predicted, std::uint8_t& state, double magnitude) {
    const std::size_t size = law_.mixture.pick_size(magnitude, random_.uniform());
    state = static_cast<std::uint8_t>(size + 1);
    const double good = law_.mixture.core * predicted.variance;
    const double gross = law_.mixture.ratio[size] * law_.unit;
    const double share = good / (good + gross);
    return predicted.mean + share * error + std::sqrt(share * gross) * random_.normal();
  }

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
  double variance_ = -1.0;  ///< of the last sample's law, and its root
  double sd_ = 0.0;
  std::array<double, kTable + 1> chance_{};
};

template <int N, bool Quantized>
void sweep(const CompletionLaw& law, const CompletionArrays& arrays, Random& random, ResidualHistogram& histogram,
           const RunControl& control) {
  const std::size_t samples = arrays.recorded.size();
  const Chain<N, Quantized> chain(law, samples);
  const double* const recorded = arrays.recorded.data();
  const std::uint8_t* const states = arrays.state.data();
  const std::size_t blocks = (samples + kBlock - 1) / kBlock;
  std::vector<Information<N>> at_end(blocks);  // information in samples after the block
  Information<N> information;
  for (std::size_t block = blocks; block-- > 0;) {
    if (control.stop.stop_requested()) {
      return;
    }
    at_end[block] = information;
    for (std::size_t t = std::min(samples, (block + 1) * kBlock); t-- > block * kBlock && block > 0;) {
      chain.back(information, recorded[t] - law.pivot, states[t]);
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
    const auto see = [&](std::size_t t, const Predicted& predicted) {
      double magnitude = 0.0;
      std::uint8_t state = kGoodSample;
      const double sample = judge.judge(recorded[t] - law.pivot, predicted, state, magnitude);
      arrays.state[t] = state;
      histogram.add(magnitude);
      arrays.completed[t] = state == kGoodSample ? recorded[t] : sample + law.pivot;
      if (!arrays.residual.empty()) {
        arrays.residual[t] = static_cast<float>(magnitude);
      }
      return sample;
    };
    for (std::size_t t = first; t < last;) {
      t += past.run(
          later.data() + (t - first), last - t, [&](std::size_t i) { return states[t + i] == kAbsentSample; },
          [&](std::size_t i, const Predicted& predicted) { return see(t + i, predicted); });
      if (t == last) {
        break;
      }
      const Predicted predicted = past.predict(later[t - first]);
      if (states[t] == kAbsentSample) {
        const double sample = judge.draw(predicted);
        arrays.completed[t] = sample + law.pivot;
        if (!arrays.residual.empty()) {
          arrays.residual[t] = 0.0F;
        }
        past.advance(sample);
      } else {
        past.advance(see(t, predicted));
      }
      ++t;
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
