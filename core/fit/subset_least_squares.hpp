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

/// argmin |A x - b|^2 over x >= 0, for at most 12 columns, by 2^columns small solves. A subset whose columns are
/// linearly dependent to 12 digits is skipped, since a smaller one fits as well. The result is refined by QR, so that
/// it is as accurate as b.
[[nodiscard]] SubsetSolution subset_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                  const Eigen::Ref<const Eigen::VectorXd>& b);

/// The same for many choices of columns of one matrix, from their inner products alone, as a scan over a grid needs it.
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
