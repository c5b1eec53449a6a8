#pragma once
/// Exact non-negative least squares for few columns: every subset of them is solved and the best feasible one kept.
#include <Eigen/Core>

#include <span>
#include <vector>

namespace driftlab {

struct SubsetSolution {
  Eigen::VectorXd x;  ///< >= 0, exact zeros outside the best subset
  double squared_residual = 0.0;
};

/// argmin |A x - b|^2 over x >= 0, for at most 12 columns: 2^columns small solves. A subset whose columns depend on
/// each other to 12 digits is passed over (a smaller one fits as well). The result is polished by QR, so it has the
/// digits of b.
[[nodiscard]] SubsetSolution subset_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                  const Eigen::Ref<const Eigen::VectorXd>& b);

/// The same over many choices of columns of one matrix, from their inner products alone: what a scan over a grid needs.
class GramProblem {
 public:
  GramProblem(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b);
  /// Solution over the columns `picked`; accurate to some 1e-10 of |b|^2.
  [[nodiscard]] SubsetSolution best_subset(std::span<const Eigen::Index> picked) const;
  /// Its squared residual alone, by an active-set method that solves a few subsets instead of all.
  [[nodiscard]] double least_residual(std::span<const Eigen::Index> picked) const;

 private:
  Eigen::MatrixXd gram_;     ///< of the columns scaled to unit length
  Eigen::VectorXd product_;  ///< with b
  Eigen::VectorXd length_;
  double b_squared_;
};

}  // namespace driftlab
