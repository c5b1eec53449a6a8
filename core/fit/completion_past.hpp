#pragma once
/// Forward part of a completion sweep (completion.hpp): the Kalman filter over the completed past, and the law of a
/// sample given that past and the information of completion_chain.hpp. Part of completion.cpp alone.
#include "core/fit/completion_chain.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::completion {

/// The filter's gain counts as settled, and is computed no more, once no entry changes by this much over one sample.
inline constexpr double kSettled = 1e-9;
/// The weights of later information are used again while its precision has changed by a smaller share than this.
inline constexpr double kSame = 1e-5;

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

  /// What predict() and advance() do for `count` samples, as long as the gain has settled, the weights hold and `see`,
  /// which is given the number of the sample and its law and returns the completed sample, is not told to stop by
  /// `stop`. Returns how many samples it took. The state stays in registers, which takes a third of the time.
  template <class Stop, class See>
  std::size_t run(const Information<N>* later, std::size_t count, Stop&& stop, See&& see) {
    if (!settled_) {
      return 0;
    }
    const Vector<N> transition = chain_.transition();
    const Vector<N> gain = gain_;
    const Vector<N> weight = weight_;
    Vector<N> lowest{};
    Vector<N> highest{};
    for (int k = 0; k < N; ++k) {
      lowest[k] = weighed_[k] - kSame * weighed_[k];
      highest[k] = weighed_[k] + kSame * weighed_[k];
    }
    Vector<N> mean = mean_;
    std::size_t i = 0;
    for (; i < count && !stop(i); ++i) {
      const Information<N>& ahead = later[i];
      bool same = true;
      for (int k = 0; k < N; ++k) {
        same = same && ahead.precision[k][k] >= lowest[k] && ahead.precision[k][k] <= highest[k];
      }
      if (!same) {
        break;
      }
      double level = 0.0;
      Vector<N> next{};
      for (int k = 0; k < N; ++k) {
        level += Chain<N, Quantized>::sight(k) * mean[k];
        next[k] = transition[k] * mean[k];
      }
      double expected = level;
      for (int r = 0; r < N; ++r) {
        double seen = 0.0;
        for (int c = 0; c < N; ++c) {
          seen += ahead.precision[r][c] * next[c];
        }
        expected += weight[r] * (ahead.shift[r] - seen);
      }
      const double innovation = see(i, Predicted{expected, spread_}) - level;
      for (int k = 0; k < N; ++k) {
        mean[k] = next[k] + gain[k] * innovation;
      }
    }
    mean_ = mean;
    return i;
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
  /// Whether the weights that were computed last can be used for this sample too: since then no diagonal entry of the
  /// precision of the later information has changed by more than kSame of its value.
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
  Vector<N> weighed_{};  ///< diagonal of the precision for which the weights were computed
  double level_ = 0.0;
  double variance_ = 0.0;  ///< of s_t given the past
  double spread_ = 0.0;    ///< of s_t given the past and the later information
  bool settled_ = false;
};

}  // namespace driftlab::completion
