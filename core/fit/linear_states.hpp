#pragma once
/// A composite model as a few independent scalar states seen through one noisy sum: the form completion.hpp works in.
///
///   x_{t+1} = T x_t + w_t,   y_t = z' x_t + e_t,   cov w = diag(noise), var e = white + error, T = diag(transition).
///
/// The first state is the level (a constant bias of unknown value, or a random walk), then one per Gauss-Markov
/// process, all with z = 1. Quantization noise e_t = a_t - a_{t-1} adds one state, the previous error a_{t-1} (T = 0,
/// z = -1), and correlates noises: cov(w, e) = error for that state. White noise is e_t.
#include "core/process/model.hpp"

#include <array>
#include <optional>

namespace driftlab {

struct LinearStates {
  static constexpr int kMost = 4;
  int count = 0;
  bool quantization = false;  ///< the last state is the previous quantization error
  std::array<double, kMost> transition{};
  std::array<double, kMost> noise{};
  std::array<double, kMost> start{};  ///< variance before the first sample, mean 0
  double white = 0.0;                 ///< at least 10^-6 of the other noises, so that densities exist
  double error = 0.0;                 ///< variance of a_t

  /// Variance of a sample given all others of an endless record, 1/mean of 1/S(f): what a residual is measured in.
  [[nodiscard]] double leave_one_out_variance() const;
};

/// Nothing where a process has no such form (flicker, drift, sinusoid) or the states are more than kMost.
/// `level_variance`: how far the level may lie from 0 at the start [unit^2].
[[nodiscard]] std::optional<LinearStates> linear_states(const Model& model, double dt_s, double level_variance);

}  // namespace driftlab
