#pragma once
/// A composite model as a few independent scalar states observed through one noisy sum, the form in which
/// completion.hpp works.
///
///   x_{t+1} = T x_t + w_t,   y_t = z' x_t + e_t,   cov w = diag(noise), var e = white + error, T = diag(transition).
///
/// The first state is the level (a constant bias of unknown value, or a random walk); one state per Gauss-Markov
/// process follows; all have z = 1. Quantization noise e_t = a_t - a_{t-1} adds one state, the previous error a_{t-1}
/// with T = 0 and z = -1, and makes the noises of that state correlated: cov(w, e) = error. White noise is part of e_t.
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

  /// Variance of a sample given all other samples of an endless record, the reciprocal of the mean of 1/S(f). Residuals
  /// are measured in this unit.
  [[nodiscard]] double leave_one_out_variance() const;
};

/// Nothing if a process has no such form (flicker noise, drift, sinusoid) or if there are more than kMost states.
/// `level_variance` is the prior variance of the level about 0 at the start [unit^2].
[[nodiscard]] std::optional<LinearStates> linear_states(const Model& model, double dt_s, double level_variance);

}  // namespace driftlab
