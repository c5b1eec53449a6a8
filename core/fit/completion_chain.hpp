#pragma once
/// Backward part of a completion sweep (completion.hpp): what all later samples say about the states, in the
/// information form of the Kalman filter. Part of completion.cpp alone.
#include "core/fit/completion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace driftlab::completion {

/// Over a long run of good samples the precision of the later information converges. A precision whose entries differ
/// from that limit by less than this, relative to its diagonal, is taken to have reached it.
inline constexpr double kAsEndless = 1e-7;
/// The limit is found by following such a run until a further sample changes no diagonal entry by more than kSettledRun
/// of its value. If that takes more than this many samples, the limit is not used and every sample is computed in full.
inline constexpr std::size_t kLongestRun = 100000;
inline constexpr double kSettledRun = 1e-12;

template <int N>
using Vector = std::array<double, static_cast<std::size_t>(N)>;
template <int N>
using Matrix = std::array<Vector<N>, static_cast<std::size_t>(N)>;

/// Log-likelihood of later samples as a function of the state: -x' precision x/2 + x' shift.
template <int N>
struct Information {
  Matrix<N> precision{};
  Vector<N> shift{};
  bool endless = false;  ///< the precision has reached the limit of a long run of good samples
};

/// The states of one model, and how information moves back over one sample of a series of `samples`.
template <int N, bool Quantized>
class Chain {
 public:
  Chain(const CompletionLaw& law, std::size_t samples) {
    const LinearStates& states = law.states;
    for (int k = 0; k < N; ++k) {
      const auto at = static_cast<std::size_t>(k);
      transition_[at] = states.transition[at];
      noise_[at] = states.noise[at];
      start_[at] = states.start[at];
    }
    error_ = states.error;
    variance_ = states.white + states.error;
    good_weight_ = 1.0 / variance_;
    // The filter's own variances are the model's; the core says by how much residuals are wider or narrower.
    for (std::size_t k = 0; k < law.mixture.ratio.size(); ++k) {
      size_[k] = law.mixture.ratio[k] * law.unit / law.mixture.core;
    }
    settle(samples);
  }

  static constexpr double sight(int k) { return Quantized && k == N - 1 ? -1.0 : 1.0; }
  [[nodiscard]] double variance() const { return variance_; }
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] const Vector<N>& transition() const { return transition_; }
  [[nodiscard]] const Vector<N>& noise() const { return noise_; }
  [[nodiscard]] const Vector<N>& start() const { return start_; }

  /// Takes the information that the samples after t hold about x_{t+1}, and makes of it the information that sample t
  /// and those after it hold about x_t. Where the precision has reached its limit and sample t is good, the precision
  /// stays as it is and the new shift is linear in the old one and in y.
  [[gnu::always_inline]] void back(Information<N>& information, double y, std::uint8_t state) const {
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
  /// Two states whose noises are independent: as below, with both noises integrated out at once, which takes one
  /// division where one after the other takes two that wait for each other.
  [[gnu::always_inline]] void move_two(Information<N>& information, double y, std::uint8_t state) const {
    const double weight = state == kGoodSample     ? good_weight_
                          : state == kAbsentSample ? 0.0
                                                   : 1.0 / (variance_ + size_[state - 1U]);
    auto& p = information.precision;
    auto& h = information.shift;
    const double a = p[0][0];
    const double b = p[0][1];
    const double d = p[1][1];
    const double determinant = a * d - b * b;
    const double lower = 1.0 / ((1.0 + a * noise_[0] + d * noise_[1]) + noise_[0] * noise_[1] * determinant);
    const Vector<N> shift = h;
    p[0][0] = transition_[0] * transition_[0] * (a + noise_[1] * determinant) * lower + weight;
    p[0][1] = transition_[0] * transition_[1] * b * lower + weight;
    p[1][0] = p[0][1];
    p[1][1] = transition_[1] * transition_[1] * (d + noise_[0] * determinant) * lower + weight;
    h[0] = transition_[0] * lower * ((1.0 + d * noise_[1]) * shift[0] - b * noise_[1] * shift[1]) + weight * y;
    h[1] = transition_[1] * lower * ((1.0 + a * noise_[0]) * shift[1] - b * noise_[0] * shift[0]) + weight * y;
  }

  [[gnu::always_inline]] void move(Information<N>& information, double y, std::uint8_t state) const {
    if constexpr (N == 2 && !Quantized) {
      move_two(information, y, state);
    } else {
      move_each(information, y, state);
    }
  }

  void move_each(Information<N>& information, double y, std::uint8_t state) const {
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

  /// Finds the limit of the precision over a long run of good samples, and how the shift changes over one of them. It
  /// gives up after a quarter of the series: a limit that is reached so late would save nothing.
  void settle(std::size_t samples) {
    Information<N> endless;
    const std::size_t longest = std::min(kLongestRun, samples / 4);
    for (std::size_t step = 0; step < longest && !settled_; ++step) {
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
  double good_weight_ = 0.0;
  std::array<double, OutlierMixture::kMostSizes> size_{};
  Matrix<N> endless_{};
  Matrix<N> from_shift_{};
  Vector<N> from_sample_{};
  bool settled_ = false;
};

}  // namespace driftlab::completion
