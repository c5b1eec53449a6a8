/// A matrix of blocks does what the same matrix does as a whole.
#include "core/process/block_diagonal.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace driftlab {
namespace {

struct Both {
  BlockDiagonal blocks;
  Eigen::MatrixXd whole;
};

Both drawn(unsigned seed) {
  std::srand(seed);  // NOLINT(cert-msc51-cpp): Eigen's Random goes by it
  std::vector<Eigen::MatrixXd> blocks{Eigen::MatrixXd::Random(3, 3), Eigen::MatrixXd::Random(1, 1),
                                      Eigen::MatrixXd::Random(5, 5)};
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(9, 9);
  whole.block(0, 0, 3, 3) = blocks[0];
  whole.block(3, 3, 1, 1) = blocks[1];
  whole.block(4, 4, 5, 5) = blocks[2];
  return {BlockDiagonal(std::move(blocks)), whole};
}

Eigen::MatrixXd dense(const BlockDiagonal& matrix) {
  return matrix * Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows()).eval();
}

TEST(BlockDiagonal, MultipliesLikeTheWholeMatrix) {
  const auto [blocks, whole] = drawn(1);
  ASSERT_EQ(blocks.rows(), 9);
  const Eigen::VectorXd vector = Eigen::VectorXd::Random(9);
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(9, 4);
  EXPECT_LT((blocks * vector - whole * vector).norm(), 1e-14);
  EXPECT_LT((blocks * matrix - whole * matrix).norm(), 1e-14);
  EXPECT_LT((blocks.after(matrix.transpose()) - matrix.transpose() * whole).norm(), 1e-14);
}

TEST(BlockDiagonal, IsRaisedChangedAndPutAroundAnother) {
  const auto [blocks, whole] = drawn(2);
  const auto [middle, whole_middle] = drawn(3);
  const Eigen::VectorXd by = Eigen::VectorXd::Random(9);
  EXPECT_LT((dense(blocks.raised(by)) - whole - Eigen::MatrixXd(by.asDiagonal())).norm(), 1e-14);
  EXPECT_LT((dense(blocks.around(middle)) - whole * whole_middle * whole.transpose()).norm(), 1e-14);
  const BlockDiagonal doubled =
      blocks.each([](const BlockDiagonal::Block& block) -> Eigen::MatrixXd { return 2.0 * block.matrix; });
  EXPECT_LT((dense(doubled) - 2.0 * whole).norm(), 1e-14);
}

TEST(BlockDiagonal, OneBlockIsAnOrdinaryMatrixBitByBit) {
  const Eigen::MatrixXd whole = Eigen::MatrixXd::Random(17, 17);
  const Eigen::VectorXd vector = Eigen::VectorXd::Random(17);
  const BlockDiagonal one(whole);
  EXPECT_EQ(one * vector, Eigen::VectorXd(whole * vector));
  EXPECT_EQ(one.whole(), whole);
}

}  // namespace
}  // namespace driftlab
