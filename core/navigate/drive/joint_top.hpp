#pragma once
/// The top of the log likelihood over several knobs together. Internal to the explanation.
///
/// One knob after the other, a search stands still on a ridge: with lasting errors of positions of (0.2 m, 10 s) the
/// log likelihood falls whichever of the two is turned, and rises by 6 towards (0.3 m, 20 s). The curvature along one
/// knob is its uncertainty only if the others are known. Here a parabola is laid through the log likelihoods at steps
/// h_i of each knob and of each pair,
///
///     H_ii = -(f(+h_i) + f(-h_i) - 2 f(0)),   H_ij = -(f(+h_i, +h_j) - f(+h_i) - f(+h_j) + f(0)),
///     g_i = (f(+h_i) - f(-h_i))/2,
///
/// whose top lies at H^-1 g, with Var = scale H^-1 as for one knob (likelihood.hpp). Along an eigenvector of the
/// correlation matrix of H that is nearly flat, steps of single knobs are too short to show its curvature: there f is
/// asked again, at a distance at which it falls by about what one standard error costs, scale/2.
///
/// Sizes that cannot be negative (Knob::magnitude and companions) are turned in equal ratios: ridges between them, such
/// as sigma^2/tau = const, are then straight.
#include "core/navigate/drive/profile.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab::drive {

class JointTop {
 public:
  /// Sorts with the knobs: how far each is turned to either side, SI; 0 leaves a knob as it is.
  JointTop(const Profile& profile, const FilterOptions& options, const std::vector<const Knob*>& knobs,
           const std::vector<double>& steps, double scale);

  /// The options at the top, every knob within its range, at most kFarthest standard errors away in any direction.
  [[nodiscard]] FilterOptions at_top() const;
  /// Standard error of a knob, the others being as uncertain as they are, SI; 0 for one that was not turned, or along
  /// which the likelihood has no top.
  [[nodiscard]] double se(std::size_t knob) const;
  /// The same with the companions of its own cause known: by how many of these it differs from 0 says whether the cause
  /// is there, where a companion may leave open how large it is.
  [[nodiscard]] double se_beside_companions(std::size_t knob) const;

 private:
  static constexpr double kFarthest = 3.0;
  static constexpr double kWeak = 0.3;   ///< eigenvalues below it are measured along their vector
  static constexpr double kFlat = 0.02;  ///< of the likelihood's roughness: no shorter first stride along a vector
  static constexpr int kStrides = 4;

  /// An eigenvector in steps of the turned knobs: `length` of it away, f has changed by
  /// slope length - curvature length^2/2.
  struct Direction {
    Eigen::VectorXd steps;
    double curvature = 0.0;
    double slope = 0.0;
  };

  /// The curvatures over some of the turned knobs as directions.
  [[nodiscard]] std::vector<Direction> directions_of(const std::vector<std::size_t>& which) const;
  /// Measures a nearly flat one again, from far enough.
  void measure(Direction& direction) const;
  /// `from` turned by `length` of a direction.
  [[nodiscard]] FilterOptions along(const Direction& direction, double length, FilterOptions from) const;
  /// How far a knob would have to be turned from `there` to lie in its range; 0 where it does.
  [[nodiscard]] double outside(std::size_t knob, const FilterOptions& there) const;
  [[nodiscard]] double se_over(std::size_t knob, const std::vector<std::size_t>& which,
                               const std::vector<Direction>& directions) const;

  const Profile& profile_;
  FilterOptions options_;
  std::vector<const Knob*> knobs_;
  std::vector<double> steps_;
  double scale_;
  double top_ = 0.0;                   ///< f(0)
  std::vector<std::size_t> turned_;    ///< knobs along which the likelihood has a top
  Eigen::MatrixXd curvature_;          ///< H
  Eigen::VectorXd slope_;              ///< g
  std::vector<Direction> directions_;  ///< of all turned knobs
};

}  // namespace driftlab::drive
