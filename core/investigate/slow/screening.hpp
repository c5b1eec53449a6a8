#pragma once
/// Gains of regressors at a fixed noise model, in every scope at once.
///
/// Whitened recordings are independent, so inner products over a scope are sums over its recordings. Let z be the
/// whitened data, B the whitened regressors that are already included, and x the new regressor restricted to a scope.
/// The gain in twice the log likelihood is (x'Mz)^2 / x'Mx with M = I - B (B'B)^-1 B', or its matrix form for two
/// columns.
#include "core/investigate/slow/slow_model.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab::investigate {

/// Gram matrices per recording: columns are data, regressors, then the new effect.
class ScopedGram {
 public:
  /// `fixed`: number of leading columns (data and regressors).
  ScopedGram(const BlockColumns& whitened, std::size_t fixed);
  [[nodiscard]] double gain(const std::vector<std::size_t>& scope) const;
  /// Sine and cosine columns with one amplitude and free phases: -2 ln P of T = (sum sqrt(n_r X_r))^2 / sum n_r, X_r
  /// the gain in recording r and n_r its information on an amplitude (see lines.hpp for the law of T).
  [[nodiscard]] double surprise_of_common_amplitude(const std::vector<std::size_t>& scope) const;
  /// The same where each member already has its two columns, in the order of `members`.
  [[nodiscard]] double surprise_of_members(const std::vector<std::size_t>& members) const;
  [[nodiscard]] double gain_of_member(std::size_t r, const std::vector<std::size_t>& members) const;

 private:
  /// Gain and information of columns [from, from + 2) in recording r.
  struct Pair {
    double gain = 0.0, information = 0.0;
  };
  [[nodiscard]] Pair pair_in(std::size_t r, Eigen::Index from) const;
  Eigen::Index fixed_;
  std::vector<Eigen::MatrixXd> gram_;
  Eigen::MatrixXd all_;
};

/// Keeps the better of two candidates for one cause and scope.
template <class Candidate>
void offer(std::vector<Candidate>& best, Candidate candidate) {
  for (Candidate& known : best) {
    if (known.cause == candidate.cause && known.members == candidate.members) {
      if (candidate.score > known.score) {
        known = std::move(candidate);
      }
      return;
    }
  }
  best.push_back(std::move(candidate));
}

}  // namespace driftlab::investigate
