#pragma once
/// Least squares with non-negative coefficients: argmin |A x - b|^2, x >= 0 (Lawson and Hanson 1974, chapter 23).
#include <Eigen/Core>

#include <vector>

namespace driftlab {

struct NonnegativeSolution {
  Eigen::VectorXd x;  ///< exact zeros where the bound holds
  double squared_residual = 0.0;
};

/// Active-set method on the normal equations of the columns scaled to unit length. Columns of zeros keep the
/// coefficient 0, and columns that are linearly dependent on those already included are not added. It is meant for the
/// small, well-scaled problems of a variance decomposition (at most some 20 columns); the relative accuracy of the
/// residual is about 1e-10. The cost is O(columns^4) at worst.
[[nodiscard]] NonnegativeSolution nonnegative_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                            const Eigen::Ref<const Eigen::VectorXd>& b);

}  // namespace driftlab
