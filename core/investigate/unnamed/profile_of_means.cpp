#include "core/investigate/unnamed/profile_of_means.hpp"

#include "core/process/dense.hpp"

#include <algorithm>
#include <vector>

namespace driftlab::investigate {

BinMeans fit_bin_means(const Eigen::MatrixXd& gram) {
  const Eigen::Index bins = gram.rows() - 1;
  Eigen::MatrixXd normal = gram.block(1, 1, bins, bins);
  double trace = 0.0;  // GCC 12 takes Eigen's for one of no element
  for (Eigen::Index b = 0; b < bins; ++b) {
    trace += normal(b, b);
  }
  const double ridge = 1e-9 * std::max(trace / static_cast<double>(bins), 1e-300);
  normal.diagonal().array() += ridge;
  const Eigen::VectorXd moment = gram.col(0).segment(1, bins);
  const Eigen::VectorXd plain = solve_symmetric(normal, moment);
  // A constant in all bins is no profile, and has no information: of the error only what is orthogonal to it counts.
  const Eigen::MatrixXd centre =
      Eigen::MatrixXd::Identity(bins, bins) - Eigen::MatrixXd::Constant(bins, bins, 1.0 / static_cast<double>(bins));
  const Eigen::VectorXd error = (centre * inverse(normal) * centre).diagonal().cwiseMax(0.0);
  const Eigen::VectorXd centred = centre * plain;
  const double prior = std::max(0.0, (centred.cwiseAbs2() - error).mean());
  BinMeans fit{Eigen::VectorXd::Zero(bins), error.cwiseSqrt()};
  if (prior > 0.0) {
    normal.diagonal().array() += 1.0 / prior;
    fit.amplitude = centre * solve_symmetric(normal, moment);
  }
  return fit;
}

BlockColumns narrowed(const BlockColumns& columns, std::size_t width) {
  BlockColumns first;
  first.width = width;
  for (const std::vector<double>& rows : columns.rows) {
    std::vector<double>& own = first.rows.emplace_back();
    for (std::size_t at = 0; at < rows.size(); at += columns.width) {
      own.insert(own.end(), rows.begin() + static_cast<std::ptrdiff_t>(at),
                 rows.begin() + static_cast<std::ptrdiff_t>(at + width));
    }
  }
  return first;
}

}  // namespace driftlab::investigate
