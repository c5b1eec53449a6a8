#include "core/investigate/unnamed/profile_of_means.hpp"

#include "core/process/dense.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

/// Means of which a few are of one size and the others none: each drawn by what it is likely to be.
Eigen::VectorXd few_of(const Eigen::VectorXd& mean, const Eigen::VectorXd& variance) {
  constexpr int kSteps = 50;
  constexpr double kFirstShare = 0.1;
  double share = kFirstShare;
  double prior = std::max(mean.cwiseAbs2().maxCoeff(), 1e-300);
  Eigen::VectorXd likely(mean.size());
  for (int step = 0; step < kSteps; ++step) {
    double among = 0.0;
    double squares = 0.0;
    for (Eigen::Index b = 0; b < mean.size(); ++b) {
      const double v = std::max(variance[b], 1e-300);
      const double drawn = prior / (prior + v);
      // ln of the two densities' ratio: N(0, t^2 + v) over N(0, v).
      const double nats = 0.5 * (std::log(v / (prior + v)) + mean[b] * mean[b] / v * drawn);
      likely[b] = share / (share + (1.0 - share) * std::exp(-nats));
      among += likely[b];
      squares += likely[b] * (drawn * drawn * mean[b] * mean[b] + drawn * v);
    }
    share = std::clamp(among / static_cast<double>(mean.size()), 1e-6, 1.0 - 1e-6);
    prior = std::max(squares / std::max(among, 1e-300), 1e-300);
  }
  Eigen::VectorXd drawn(mean.size());
  for (Eigen::Index b = 0; b < mean.size(); ++b) {
    drawn[b] = likely[b] * prior / (prior + std::max(variance[b], 1e-300)) * mean[b];
  }
  return drawn;
}

double middle_of(Eigen::VectorXd values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BinMeans fit_bin_means(const Eigen::MatrixXd& gram, ExpectedMeans expected) {
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
  if (expected == ExpectedMeans::Few) {
    // What the many have is the constant.
    fit.amplitude = centre * few_of(plain.array() - middle_of(plain), error);
    return fit;
  }
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
