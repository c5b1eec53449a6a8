#pragma once
/// A square matrix that is zero outside of blocks along its diagonal.
///
/// The covariance of variances of several recordings is one: what is measured of one recording says nothing about the
/// errors of another. With R recordings of m scales each, a product with a vector takes R m^2 steps and a factor of
/// Cholesky R m^3, where the matrix as a whole would take (R m)^2 and (R m)^3, and as many bytes. One recording is the
/// case of one block, whose arithmetic is that of an ordinary matrix.
#include <Eigen/Core>

#include <functional>
#include <vector>

namespace driftlab {

class BlockDiagonal {
 public:
  struct Block {
    Eigen::Index first = 0;  ///< row and column where it begins
    Eigen::MatrixXd matrix;
  };

  BlockDiagonal() = default;
  /// One block. Not explicit: a matrix is the case of one recording.
  BlockDiagonal(const Eigen::MatrixXd& whole);  // NOLINT(google-explicit-constructor)
  /// Square blocks, in their order.
  explicit BlockDiagonal(std::vector<Eigen::MatrixXd> blocks);

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
  /// The matrix, where it is one block.
  [[nodiscard]] const Eigen::MatrixXd& whole() const { return blocks_.front().matrix; }

  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& vector) const;
  /// `matrix` has as many rows as this.
  [[nodiscard]] Eigen::MatrixXd operator*(const Eigen::MatrixXd& matrix) const;
  /// left A: `left` has as many columns as this has rows.
  [[nodiscard]] Eigen::MatrixXd after(const Eigen::MatrixXd& left) const;
  /// With each block replaced by what `change` makes of it, which has its size.
  [[nodiscard]] BlockDiagonal each(const std::function<Eigen::MatrixXd(const Block&)>& change) const;
  /// With `by` added to the diagonal: one entry a row.
  [[nodiscard]] BlockDiagonal raised(const Eigen::VectorXd& by) const;
  /// A C A' for this A and a C of the same blocks.
  [[nodiscard]] BlockDiagonal around(const BlockDiagonal& middle) const;

 private:
  std::vector<Block> blocks_;
  Eigen::Index rows_ = 0;
};

}  // namespace driftlab
