#pragma once
/// Dense linear algebra over matrices whose size is known at run time.
///
/// Each function is one call of Eigen, compiled in dense.cpp alone: the templates behind a decomposition take longer to
/// compile than the files that use it. Matrices of fixed size stay with Eigen where they are used; there they are
/// cheap. Nothing throws, nothing is random; sizes that do not fit are the caller's error (an assertion in debug
/// builds).
#include <Eigen/Core>

#include <optional>

namespace driftlab {

/// The x of least |a x - b|, by QR with column pivoting; of a column that depends on others the share is zero.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// The same for every column of b.
[[nodiscard]] Eigen::MatrixXd least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The x of a x = b for a symmetric positive semidefinite a, by LDL'. Only the lower triangle is read.
[[nodiscard]] Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The inverse of a square matrix, by LU with partial pivoting. A singular matrix gives infinities or NaN.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

/// L^-1 of a = L L'; nothing where `a` is not positive definite to rounding. Only the lower triangle is read.
[[nodiscard]] std::optional<Eigen::MatrixXd> inverse_cholesky(const Eigen::MatrixXd& a);

/// Eigenvalues of a symmetric matrix, rising, and their unit vectors as columns. Only the lower triangle is read.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& a);

/// Singular values, falling.
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

}  // namespace driftlab
