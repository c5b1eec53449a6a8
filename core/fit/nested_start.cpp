#include "core/fit/nested_start.hpp"

#include "core/process/dense.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kPointsOne = 48;
constexpr std::size_t kPointsMore = 10;
constexpr std::size_t kStarts = 2;
/// A second start is worth a search only if it promises this share of the first's fall.
constexpr double kWorthwhile = 0.2;

/// Level 1 at every point of a grid over the shapes, the first shape changing fastest.
std::vector<Process> grid_of(const ProcessKind& kind, const WaveletMoments& moments) {
  std::vector<Process> grid{{&kind, std::vector<double>(kind.parameters.size(), 1.0)}};
  const std::size_t points = kind.parameters.size() > 2 ? kPointsMore : kPointsOne;
  for (std::size_t k = 1; k < kind.parameters.size(); ++k) {
    const auto [low, high] = kind.shape_range(k - 1, moments.dt_s, moments.samples);
    std::vector<Process> finer;
    for (std::size_t g = 0; g < points; ++g) {
      for (Process process : grid) {
        process.parameters[k] = low * std::pow(high / low, static_cast<double>(g) / static_cast<double>(points - 1));
        finer.push_back(std::move(process));
      }
    }
    grid = std::move(finer);
  }
  return grid;
}

}  // namespace

std::vector<Model> starts_with_more(const WaveletMoments& moments, const LogFit& smaller, const ProcessKind& added) {
  const std::vector<Process> grid = grid_of(added, moments);
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  smaller.evaluate(smaller.best(), &residual, &jacobian);
  const Model model = smaller.model();
  const std::vector<Eigen::Index>& used = smaller.curve().curve.used;
  Eigen::MatrixXd shares(residual.size(), static_cast<Eigen::Index>(grid.size()));
  for (Eigen::Index j = 0; j < shares.rows(); ++j) {
    const auto row = static_cast<std::size_t>(used[static_cast<std::size_t>(j)]);
    const double described = haar_variance(model, moments.half[row], moments.dt_at(row));
    for (Eigen::Index g = 0; g < shares.cols(); ++g) {
      shares(j, g) = grid[static_cast<std::size_t>(g)].haar_variance(moments.half[row], moments.dt_at(row)) / described;
    }
  }
  const Eigen::VectorXd largest = shares.colwise().maxCoeff();
  Eigen::MatrixXd whitened = smaller.curve().whitening * shares;
  whitened -= jacobian * least_squares(jacobian, whitened);

  Eigen::VectorXd amount = Eigen::VectorXd::Zero(shares.cols());
  Eigen::VectorXd fall = Eigen::VectorXd::Zero(shares.cols());
  for (Eigen::Index g = 0; g < shares.cols(); ++g) {
    const double along = whitened.col(g).dot(residual);
    const double square = whitened.col(g).squaredNorm();
    if (along > 0.0 && square > 1e-20 * largest(g) * largest(g)) {
      amount(g) = along / square;
      fall(g) = along * along / square;
    }
  }
  const Eigen::VectorXd whole = fall;
  std::vector<Model> starts;
  double first = 0.0;
  Eigen::Index first_at = -3;
  while (starts.size() < kStarts) {
    Eigen::Index best = 0;
    const double promised = fall.maxCoeff(&best);
    if (!(promised > kWorthwhile * first)) {
      break;
    }
    const bool fresh = std::abs(best - first_at) > 2;
    const bool peak =
        (best == 0 || whole(best - 1) <= promised) && (best + 1 == whole.size() || whole(best + 1) <= promised);
    fall(best) = 0.0;
    if (!fresh || !peak) {
      continue;
    }
    first = starts.empty() ? promised : first;
    first_at = best;
    Model start = model;
    start.push_back(grid[static_cast<std::size_t>(best)]);
    // The first order says little where it would multiply the curve.
    start.back().parameters[0] = std::sqrt(std::min(amount(best), 10.0 / largest(best)));
    starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace driftlab
