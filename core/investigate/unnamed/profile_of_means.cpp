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

/// The inverse in the directions of which there is information: a quantity that stands still in a recording tells
/// nothing of a profile there, and where all others pass a bin by, the level of the rest is the recordings' constant.
Eigen::MatrixXd known_part_of_inverse(const Eigen::MatrixXd& normal) {
  constexpr double kNothing = 1e-6;  // Of the largest eigenvalue. Chosen, not measured.
  const SymmetricEigen eigen = symmetric_eigen(normal);
  const double least = kNothing * std::max(eigen.values.maxCoeff(), 1e-300);
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(normal.rows(), normal.cols());
  for (Eigen::Index k = 0; k < normal.rows(); ++k) {
    if (eigen.values[k] > least) {
      known += eigen.vectors.col(k) * eigen.vectors.col(k).transpose() / eigen.values[k];
    }
  }
  // What is left of a bin without information is rounding.
  const double largest = known.diagonal().maxCoeff();
  for (Eigen::Index b = 0; b < known.rows(); ++b) {
    if (known(b, b) < kNothing * largest) {
      known.row(b).setZero();
      known.col(b).setZero();
    }
  }
  return known;
}

/// By moments, each bin by the certainty with which its square is known; bins without information do not count.
double prior_variance(const Eigen::VectorXd& mean, const Eigen::VectorXd& error, const Eigen::VectorXd& variance) {
  double sum = 0.0;
  double weights = 0.0;
  for (Eigen::Index b = 0; b < mean.size(); ++b) {
    if (variance[b] > 0.0 && error[b] > 0.0) {
      const double weight = 1.0 / (error[b] * error[b]);
      sum += weight * (mean[b] * mean[b] - error[b]);
      weights += weight;
    }
  }
  return weights > 0.0 ? std::max(0.0, sum / weights) : 0.0;
}

}  // namespace

BinMeans fit_bin_means(const Eigen::MatrixXd& gram, ExpectedMeans expected) {
  const Eigen::Index bins = gram.rows() - 1;
  Eigen::MatrixXd normal = gram.block(1, 1, bins, bins);
  const Eigen::VectorXd moment = gram.col(0).segment(1, bins);
  const Eigen::MatrixXd variance = known_part_of_inverse(normal);
  const Eigen::VectorXd plain = variance * moment;
  // A constant in all bins is no profile, and has no information: of the error only what is orthogonal to it counts.
  const Eigen::MatrixXd centre =
      Eigen::MatrixXd::Identity(bins, bins) - Eigen::MatrixXd::Constant(bins, bins, 1.0 / static_cast<double>(bins));
  Eigen::VectorXd error = (centre * variance * centre).diagonal().cwiseMax(0.0);
  const double largest = error.maxCoeff();
  for (Eigen::Index b = 0; b < bins; ++b) {
    error[b] = variance(b, b) > 0.0 ? error[b] : largest;
  }
  const Eigen::VectorXd centred = centre * plain;
  const double prior = prior_variance(centred, error, variance.diagonal());
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
