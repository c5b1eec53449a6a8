#pragma once
/// Candidate against baseline: the difference of every scale and every level with its covariance.
///
/// Scales (spec/regression.md, eq. 4 and 5): theta_j = sum_cand w_r x_rj - sum_base w_r x_rj with w_r ~ 1/(S_jj,r/4 +
/// K_jj), and C = sum_r w_r w_r' (S_r/4 + K) element by element, which is K (1/n + 1/m) where sessions are equally
/// long. Levels of the model are linear functions of the same vector: with D = d ln deviation/d ln level at the pooled
/// fit, theta_level = (D'C^-1 D)^-1 D'C^-1 theta. No second fit, and the covariance with the scales is known.
///
/// The levels of a unit are compared only if its structure holds: the model fits the pooled curve (J test with the
/// covariance of that curve, p >= 0.01) and explains the difference ((theta - D theta_level)' C^-1 (...) chi-square, p
/// >= 0.01). Else scales alone decide.
#include "core/campaign/regression/session_scatter.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab::regression {

/// One comparison. A test of a scale has `level` empty.
struct Test {
  std::size_t unit = 0;
  std::optional<std::size_t> level;
  Eigen::Index row = 0;  ///< of the design, for a scale
  double tau_s = 0.0;    ///< for a scale
  double margin = 0.0;   ///< [ln deviation]
};

/// Does the model of a unit hold in both arms?
struct StructureTest {
  bool compared = false;  ///< there is a model, and both tests hold
  double p_fit = 1.0;
  double p_contrast = 1.0;

  /// Of the test that speaks more against the model.
  [[nodiscard]] double least_p() const { return std::min(p_fit, p_contrast); }
};

/// What one arm has at a scale: the weighted mean of its sessions, sum_r w_r x_rj.
struct ArmMean {
  double x = 0.0;   ///< ln deviation of the Haar wavelet variance, 1/2 ln nu
  double se = 0.0;  ///< with what a session adds
};

struct Contrast {
  std::vector<Test> tests;                    ///< scales by row, then levels by unit
  std::vector<std::array<ArmMean, 2>> means;  ///< per test of a scale: baseline, candidate; theta is their difference
  Eigen::VectorXd theta;                      ///< per test [ln deviation]
  Eigen::VectorXd se;                         ///< at the posterior means of kL^2 and kS^2
  std::vector<StructureTest> structures;      ///< per unit

  /// C = sampling + kL^2 common + kS^2 local over the tests of scales; all tests are `combine` times these.
  Eigen::MatrixXd sampling;
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;
  Eigen::MatrixXd combine;
  /// w_rj^2 / sum_r w_rj^2 per test of a scale (rows) and session of the two arms (columns, by rising shares): how much
  /// of what sessions add to theta is each one's. Between five sessions and one, five sixths are that one's.
  Eigen::MatrixXd shares;
};

/// Scales that only one arm has are no tests. Without any the lists are empty.
[[nodiscard]] Contrast make_contrast(const Design& design, const ScatterTerms& terms, const SessionScatter& scatter);

}  // namespace driftlab::regression
