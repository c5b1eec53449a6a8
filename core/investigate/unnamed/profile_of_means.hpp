#pragma once
/// Means by bins, by generalised least squares on whitened blocks (slow/slow_fit.hpp). Columns are the means of the
/// blocks, a constant of each recording, and one indicator for each bin.
#include "core/investigate/slow/slow_model.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace driftlab::investigate {

struct BinMeans {
  Eigen::VectorXd amplitude;  ///< drawn towards 0 by their prior variance
  Eigen::VectorXd se;         ///< before that
};

/// How the means of a profile are expected to lie: all of one size, or a few of one size among many that are none, as
/// those of a pulse are. The share p of these and their variance t^2 are the likeliest ones (EM), and a mean with the
/// variance v is drawn by the probability that it is one of them and by t^2/(t^2 + v).
enum class ExpectedMeans { OfOneSize, Few };

/// From the inner products of means and bins, constants taken out (centred_gram).
[[nodiscard]] BinMeans fit_bin_means(const Eigen::MatrixXd& gram, ExpectedMeans expected = ExpectedMeans::OfOneSize);

/// The first `width` columns.
[[nodiscard]] BlockColumns narrowed(const BlockColumns& columns, std::size_t width);

/// Inner products of means and bins over the rows of recording m that `takes` picks, less what the constant of these
/// rows explains: each recording has a bias of its own.
template <class Takes>
[[nodiscard]] Eigen::MatrixXd centred_gram(const BlockColumns& whitened, std::size_t m, std::size_t constants,
                                           const Takes& takes) {
  const auto width = static_cast<Eigen::Index>(whitened.width);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  const std::vector<double>& rows = whitened.rows[m];
  const std::size_t blocks = rows.size() / whitened.width;
  for (std::size_t b = 0; b < blocks; ++b) {
    if (takes(b, blocks)) {
      const Eigen::Map<const Eigen::VectorXd> row(rows.data() + b * whitened.width, width);
      gram.noalias() += row * row.transpose();
    }
  }
  const auto constant = static_cast<Eigen::Index>(1 + m);
  const double own = gram(constant, constant);
  if (own > 0.0) {
    gram -= Eigen::MatrixXd(gram.col(constant) * gram.row(constant) / own);
  }
  const Eigen::Index bins = width - 1 - static_cast<Eigen::Index>(constants);
  Eigen::MatrixXd centred(bins + 1, bins + 1);
  centred(0, 0) = gram(0, 0);
  centred.block(0, 1, 1, bins) = gram.topRightCorner(1, bins);
  centred.block(1, 0, bins, 1) = gram.bottomLeftCorner(bins, 1);
  centred.block(1, 1, bins, bins) = gram.bottomRightCorner(bins, bins);
  return centred;
}

}  // namespace driftlab::investigate
