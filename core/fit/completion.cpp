#include "core/fit/completion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kBlock = 2048;
/// Gains that move less than this from one sample to the next are taken as settled.
constexpr double kSettled = 1e-9;
/// Weights are kept while the precision behind them moves less than this.
constexpr double kSame = 1e-5;
/// Precisions closer than this to that of an endless run of good samples are taken as it.
constexpr double kAsEndless = 1e-7;
/// Samples after which that run must have settled, to be used at all.
constexpr int kLongestRun = 20000;
constexpr double kSettledRun = 1e-13;
constexpr std::size_t kTable = 1024;
constexpr double kTableEnd = 8.0;

template <int N>
using Vector = std::array<double, static_cast<std::size_t>(N)>;
template <int N>
using Matrix = std::array<Vector<N>, static_cast<std::size_t>(N)>;

/// Log-likelihood of later samples as a function of the state: -x' precision x/2 + x' shift.
template <int N>
struct Information {
  Matrix<N> precision{};
  Vector<N> shift{};
  bool endless = false;  ///< the precision is that of an endless run of good samples
};

/// The states of one model, and how information moves back over one sample.
template <int N, bool Quantized>
class Chain {
 public:
  explicit Chain(const CompletionLaw& law) {
    const LinearStates& states = law.states;
    for (int k = 0; k < N; ++k) {
      const auto at = static_cast<std::size_t>(k);
      transition_[at] = states.transition[at];
      noise_[at] = states.noise[at];
      start_[at] = states.start[at];
    }
    error_ = states.error;
    variance_ = states.white + states.error;
    // The filter's own variances are the model's; the core says by how much residuals are wider or narrower.
    for (std::size_t k = 0; k < law.mixture.ratio.size(); ++k) {
      size_[k] = law.mixture.ratio[k] * law.unit / law.mixture.core;
    }
    settle();
  }

  static constexpr double sight(int k) { return Quantized && k == N - 1 ? -1.0 : 1.0; }
  [[nodiscard]] double variance() const { return variance_; }
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] const Vector<N>& transition() const { return transition_; }
  [[nodiscard]] const Vector<N>& noise() const { return noise_; }
  [[nodiscard]] const Vector<N>& start() const { return start_; }

  /// From the information about x_{t+1} in samples after t to that about x_t in samples from t on. Where it has the
  /// precision of an endless run and the sample is good only the shift moves, and that linearly.
  void back(Information<N>& information, double y, std::uint8_t state) const {
    if (!information.endless || state != kGoodSample) {
      move(information, y, state);
      information.endless = settled_ && near_endless(information.precision);
      return;
    }
    Vector<N> shift{};
    for (int r = 0; r < N; ++r) {
      double sum = from_sample_[r] * y;
      for (int c = 0; c < N; ++c) {
        sum += from_shift_[r][c] * information.shift[c];
      }
      shift[r] = sum;
    }
    information.shift = shift;
  }

 private:
  void move(Information<N>& information, double y, std::uint8_t state) const {
    const bool absent = state == kAbsentSample;
    const double spread = variance_ + (state == kGoodSample || absent ? 0.0 : size_[state - 1U]);
    const double weight = absent ? 0.0 : 1.0 / spread;
    const double carried = Quantized && !absent ? error_ * weight : 0.0;  // share of the sample's noise that is a_t
    auto& p = information.precision;
    auto& h = information.shift;
    for (int i = 0; i < N; ++i) {  // integrate the noise of each state out
      const double q = Quantized && i == N - 1 ? error_ * (1.0 - carried) : noise_[i];
      const double gain = q / (1.0 + q * p[i][i]);
      const Vector<N> column = p[i];
      const double own = h[i];
      for (int r = 0; r < N; ++r) {
        const double scaled = gain * column[r];
        for (int c = 0; c <= r; ++c) {
          p[r][c] -= scaled * column[c];
          p[c][r] = p[r][c];
        }
        h[r] -= scaled * own;
      }
    }
    // NOLINTBEGIN(misc-const-correctness): assigned where the series is quantized
    Vector<N> link{};
    double last = 0.0;
    double last_shift = 0.0;
    // NOLINTEND(misc-const-correctness)
    if constexpr (Quantized) {
      last = p[N - 1][N - 1];
      for (int r = 0; r < N; ++r) {
        link[r] = carried * transition_[r] * p[r][N - 1];
        h[r] -= carried * y * p[r][N - 1];
      }
      last_shift = carried * h[N - 1];
    }
    const double seen = weight + carried * carried * last;
    const double pull = weight * y - last_shift;
    for (int r = 0; r < N; ++r) {
      for (int c = 0; c <= r; ++c) {
        p[r][c] = transition_[r] * transition_[c] * p[r][c] + seen * sight(r) * sight(c);
        if constexpr (Quantized) {
          p[r][c] -= link[r] * sight(c) + sight(r) * link[c];
        }
        p[c][r] = p[r][c];
      }
      h[r] = transition_[r] * h[r] + sight(r) * pull;
    }
  }

  /// The precision of an endless run of good samples, and how the shift moves over one of them.
  void settle() {
    Information<N> endless;
    for (int step = 0; step < kLongestRun && !settled_; ++step) {
      const Matrix<N> before = endless.precision;
      move(endless, 0.0, kGoodSample);
      settled_ = true;
      for (int r = 0; r < N; ++r) {
        settled_ =
            settled_ && std::fabs(endless.precision[r][r] - before[r][r]) <= kSettledRun * endless.precision[r][r];
      }
    }
    endless_ = endless.precision;
    for (int c = 0; c <= N; ++c) {
      Information<N> probe;
      probe.precision = endless_;
      if (c < N) {
        probe.shift[c] = 1.0;
      }
      move(probe, c < N ? 0.0 : 1.0, kGoodSample);
      for (int r = 0; r < N; ++r) {
        (c < N ? from_shift_[r][c] : from_sample_[r]) = probe.shift[r];
      }
    }
  }

  [[nodiscard]] bool near_endless(const Matrix<N>& precision) const {
    for (int r = 0; r < N; ++r) {
      for (int c = 0; c <= r; ++c) {
        const double off = precision[r][c] - endless_[r][c];
        if (!(off * off <= kAsEndless * kAsEndless * endless_[r][r] * endless_[c][c])) {
          return false;
        }
      }
    }
    return true;
  }

  Vector<N> transition_{};
  Vector<N> noise_{};
  Vector<N> start_{};
  double error_ = 0.0;
  double variance_ = 0.0;
  std::array<double, OutlierMixture::kMostSizes> size_{};
  Matrix<N> endless_{};
  Matrix<N> from_shift_{};
  Vector<N> from_sample_{};
  bool settled_ = false;
};

/// The law of one sample given everything else.
struct Predicted {
  double mean = 0.0;
  double variance = 0.0;
};

/// Filter over the completed past.
template <int N, bool Quantized>
class Past {
 public:
  explicit Past(const Chain<N, Quantized>& chain) : chain_(chain) {
    for (int k = 0; k < N; ++k) {
      covariance_[k][k] = chain.start()[k];
    }
    settle();
  }

  /// Law of s_t given the completed samples before t and `later` about x_{t+1}.
  Predicted predict(const Information<N>& later) {
    level_ = 0.0;
    for (int k = 0; k < N; ++k) {
      level_ += Chain<N, Quantized>::sight(k) * mean_[k];
      next_[k] = chain_.transition()[k] * mean_[k];
    }
    if (!settled_ || !near_last(later)) {
      weigh(later);
    }
    Predicted law{level_, spread_};
    for (int r = 0; r < N; ++r) {
      double expected = 0.0;
      for (int c = 0; c < N; ++c) {
        expected += later.precision[r][c] * next_[c];
      }
      law.mean += weight_[r] * (later.shift[r] - expected);
    }
    return law;
  }

  /// Takes the completed sample; predict() must have been called for it.
  void advance(double sample) {
    const double innovation = sample - level_;
    for (int k = 0; k < N; ++k) {
      mean_[k] = next_[k] + gain_[k] * innovation;
    }
    if (!settled_) {
      for (int r = 0; r < N; ++r) {
        for (int c = 0; c < N; ++c) {
          covariance_[r][c] = ahead_[r][c] - link_[r] * gain_[c];
        }
      }
      settle();
    }
  }

 private:
  /// Whether the weights of the last sample still do: its precision differs by less than 10^-5.
  [[nodiscard]] bool near_last(const Information<N>& later) const {
    double moved = 0.0;
    for (int k = 0; k < N; ++k) {
      moved = std::max(moved, std::fabs(later.precision[k][k] - weighed_[k]) - kSame * weighed_[k]);
    }
    return moved <= 0.0;
  }

  /// Weights of later information about x_{t+1} in the law of s_t, and its variance.
  void weigh(const Information<N>& later) {
    // w solves (I + P L) w = c for the covariance P of x_{t+1}, L its later precision, c its covariance with s_t.
    Matrix<N> product{};  // L times the root of P
    for (int r = 0; r < N; ++r) {
      for (int c = 0; c < N; ++c) {
        double sum = 0.0;
        for (int k = c; k < N; ++k) {
          sum += later.precision[r][k] * root_[k][c];
        }
        product[r][c] = sum;
      }
    }
    Matrix<N> factor{};
    Vector<N> solved = whitened_;
    Vector<N> pivot{};
    for (int c = 0; c < N; ++c) {
      for (int r = c; r < N; ++r) {
        double sum = r == c ? 1.0 : 0.0;
        for (int k = r; k < N; ++k) {
          sum += root_[k][r] * product[k][c];
        }
        for (int k = 0; k < c; ++k) {
          sum -= factor[r][k] * factor[c][k] * pivot[k];
        }
        factor[r][c] = sum;
      }
      pivot[c] = factor[c][c];
      const double inverse = 1.0 / pivot[c];
      for (int r = c + 1; r < N; ++r) {
        factor[r][c] *= inverse;
      }
    }
    for (int r = 0; r < N; ++r) {
      for (int k = 0; k < r; ++k) {
        solved[r] -= factor[r][k] * solved[k];
      }
    }
    for (int r = N - 1; r >= 0; --r) {
      solved[r] /= pivot[r];
      for (int k = r + 1; k < N; ++k) {
        solved[r] -= factor[k][r] * solved[k];
      }
    }
    spread_ = variance_;
    for (int r = 0; r < N; ++r) {
      double w = 0.0;
      for (int k = 0; k <= r; ++k) {
        w += root_[r][k] * solved[k];
      }
      double seen = 0.0;
      for (int c = 0; c < N; ++c) {
        seen += later.precision[r][c] * link_[c];
      }
      weight_[r] = w;
      weighed_[r] = later.precision[r][r];
      spread_ -= w * seen;
    }
  }

  void settle() {
    const Vector<N> before = gain_;
    variance_ = chain_.variance();
    for (int r = 0; r < N; ++r) {
      double sum = 0.0;
      for (int c = 0; c < N; ++c) {
        sum += covariance_[r][c] * Chain<N, Quantized>::sight(c);
        ahead_[r][c] = chain_.transition()[r] * chain_.transition()[c] * covariance_[r][c];
      }
      ahead_[r][r] += chain_.noise()[r];
      variance_ += Chain<N, Quantized>::sight(r) * sum;
      link_[r] = chain_.transition()[r] * sum + (Quantized && r == N - 1 ? chain_.error() : 0.0);
    }
    double moved = 0.0;
    for (int r = 0; r < N; ++r) {
      gain_[r] = link_[r] / variance_;
      moved = std::max(moved, std::fabs(gain_[r] - before[r]));
      for (int c = 0; c <= r; ++c) {  // Cholesky
        double sum = ahead_[r][c];
        for (int k = 0; k < c; ++k) {
          sum -= root_[r][k] * root_[c][k];
        }
        root_[r][c] = r == c ? std::sqrt(std::max(sum, 1e-30 * variance_)) : sum / root_[c][c];
      }
      whitened_[r] = link_[r];
      for (int k = 0; k < r; ++k) {
        whitened_[r] -= root_[r][k] * whitened_[k];
      }
      whitened_[r] /= root_[r][r];
    }
    settled_ = moved < kSettled;
  }

  const Chain<N, Quantized>& chain_;
  Matrix<N> covariance_{};  ///< of x_t given the past
  Matrix<N> ahead_{};       ///< of x_{t+1} given the past
  Matrix<N> root_{};        ///< its Cholesky factor
  Vector<N> link_{};        ///< covariance of x_{t+1} and s_t
  Vector<N> whitened_{};    ///< root^-1 link
  Vector<N> gain_{};
  Vector<N> mean_{};
  Vector<N> next_{};
  Vector<N> weight_{};
  Vector<N> weighed_{};  ///< diagonal of the precision that the weights are for
  double level_ = 0.0;
  double variance_ = 0.0;  ///< of s_t given the past
  double spread_ = 0.0;    ///< and given what follows
  bool settled_ = false;
};

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
  const Chain<N, Quantized> chain(law);
  const std::size_t samples = arrays.recorded.size();
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
