#include "core/process/block_diagonal.hpp"

#include <cstddef>
#include <utility>

namespace driftlab {

BlockDiagonal::BlockDiagonal(const Eigen::MatrixXd& whole) : rows_(whole.rows()) { blocks_.push_back({0, whole}); }

BlockDiagonal::BlockDiagonal(std::vector<Eigen::MatrixXd> blocks) {
  blocks_.reserve(blocks.size());
  for (Eigen::MatrixXd& block : blocks) {
    const Eigen::Index rows = block.rows();
    blocks_.push_back({rows_, std::move(block)});
    rows_ += rows;
  }
}

Eigen::VectorXd BlockDiagonal::operator*(const Eigen::VectorXd& vector) const {
  Eigen::VectorXd product(rows_);
  for (const Block& block : blocks_) {
    const Eigen::Index rows = block.matrix.rows();
    product.segment(block.first, rows).noalias() = block.matrix * vector.segment(block.first, rows);
  }
  return product;
}

Eigen::MatrixXd BlockDiagonal::operator*(const Eigen::MatrixXd& matrix) const {
  Eigen::MatrixXd product(rows_, matrix.cols());
  for (const Block& block : blocks_) {
    const Eigen::Index rows = block.matrix.rows();
    product.middleRows(block.first, rows).noalias() = block.matrix * matrix.middleRows(block.first, rows);
  }
  return product;
}

Eigen::MatrixXd BlockDiagonal::after(const Eigen::MatrixXd& left) const {
  Eigen::MatrixXd product(left.rows(), rows_);
  for (const Block& block : blocks_) {
    const Eigen::Index rows = block.matrix.rows();
    product.middleCols(block.first, rows).noalias() = left.middleCols(block.first, rows) * block.matrix;
  }
  return product;
}

BlockDiagonal BlockDiagonal::each(const std::function<Eigen::MatrixXd(const Block&)>& change) const {
  BlockDiagonal changed;
  changed.rows_ = rows_;
  changed.blocks_.reserve(blocks_.size());
  for (const Block& block : blocks_) {
    changed.blocks_.push_back({block.first, change(block)});
  }
  return changed;
}

BlockDiagonal BlockDiagonal::raised(const Eigen::VectorXd& by) const {
  BlockDiagonal sum = *this;
  for (Block& block : sum.blocks_) {
    block.matrix.diagonal() += by.segment(block.first, block.matrix.rows());
  }
  return sum;
}

BlockDiagonal BlockDiagonal::around(const BlockDiagonal& middle) const {
  BlockDiagonal product = middle;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const Eigen::MatrixXd& outer = blocks_[i].matrix;
    product.blocks_[i].matrix = outer * middle.blocks_[i].matrix * outer.transpose();
  }
  return product;
}

}  // namespace driftlab
