#pragma once
/// Least squares with non-negative coefficients: argmin |A x - b|^2, x >= 0 (Lawson and Hanson 1974, chapter 23).
#include <Eigen/Core>

#include <vector>

namespace driftlab {

struct NonnegativeSolution {
  Eigen::VectorXd x;  ///< exact zeros where the bound holds
  double squared_residual = 0.0;
};

/// Active-set method on the normal equations of the columns scaled to unit length; columns of zeros stay 0, columns
/// that depend on those already in stay out. For the small, well-scaled problems of a variance decomposition (at most
/// some 20 columns): relative accuracy of the residual about 1e-10. O(columns^4) at worst.
[[nodiscard]] NonnegativeSolution nonnegative_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                                            const Eigen::Ref<const Eigen::VectorXd>& b);

}  // namespace driftlab
