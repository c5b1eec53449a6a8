#include "core/fit/subset_least_squares.hpp"

#include "core/process/dense.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace driftlab {
namespace {

constexpr std::size_t kMaxColumns = 12;
constexpr double kDependent = 1e-12;

/// Solves the subset `members` of a Gram system by Cholesky; false if the columns are dependent. `gain` is the fall of
/// the squared residual, `positive` whether all levels are.
struct SmallSolve {
  std::array<double, kMaxColumns> x{};
  double gain = 0.0;
  bool positive = false;

  bool run(const Eigen::MatrixXd& gram, const Eigen::VectorXd& product, std::span<const Eigen::Index> members) {
    const std::size_t n = members.size();
    std::array<std::array<double, kMaxColumns>, kMaxColumns> lower;  // NOLINT: written before it is read
    std::array<double, kMaxColumns> z;                               // NOLINT
    gain = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        double sum = gram(members[i], members[k]);
        for (std::size_t q = 0; q < k; ++q) {
          sum -= lower[i][q] * lower[k][q];
        }
        lower[i][k] = sum / lower[k][k];
      }
      double pivot = gram(members[i], members[i]);
      double right = product(members[i]);
      for (std::size_t q = 0; q < i; ++q) {
        pivot -= lower[i][q] * lower[i][q];
        right -= lower[i][q] * z[q];
      }
      if (!(pivot > kDependent)) {
        return false;
      }
      lower[i][i] = std::sqrt(pivot);
      z[i] = right / lower[i][i];
      gain += z[i] * z[i];
    }
    for (std::size_t i = n; i-- > 0;) {
      double sum = z[i];
      for (std::size_t k = i + 1; k < n; ++k) {
        sum -= lower[k][i] * x[k];
      }
      x[i] = sum / lower[i][i];
    }
    positive = std::all_of(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n), [](double v) { return v > 0.0; });
    return true;
  }
};

}  // namespace

GramProblem::GramProblem(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b)
    : length_(columns.colwise().norm().transpose()), b_squared_(b.squaredNorm()) {
  Eigen::MatrixXd unit = columns;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    if (length_(k) > 0.0) {
      unit.col(k) /= length_(k);
    }
  }
  gram_ = unit.transpose() * unit;
  product_ = unit.transpose() * b;
}

SubsetSolution GramProblem::best_subset(std::span<const Eigen::Index> picked) const {
  const std::size_t n = picked.size();
  SubsetSolution best;
  best.x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  double best_gain = 0.0;
  std::array<Eigen::Index, kMaxColumns> members{};
  std::array<std::size_t, kMaxColumns> position{};
  SmallSolve solve;
  for (std::size_t mask = 1; mask < (std::size_t{1} << n); ++mask) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if ((mask >> k & 1U) != 0U) {
        position[count] = k;
        members[count++] = picked[k];
      }
    }
    if (solve.run(gram_, product_, {members.data(), count}) && solve.positive && solve.gain > best_gain) {
      best_gain = solve.gain;
      best.x.setZero();
      for (std::size_t k = 0; k < count; ++k) {
        best.x(static_cast<Eigen::Index>(position[k])) = solve.x[k] / length_(members[k]);
      }
    }
  }
  best.squared_residual = b_squared_ - best_gain;
  return best;
}

double GramProblem::least_residual(std::span<const Eigen::Index> picked) const {
  // Lawson and Hanson's active set on the normal equations; positions in `picked`.
  const std::size_t n = picked.size();
  std::array<double, kMaxColumns> x{};
  std::array<std::size_t, kMaxColumns> inside{};
  std::array<Eigen::Index, kMaxColumns> members{};
  std::array<bool, kMaxColumns> barred{};
  std::size_t count = 0;
  double gain = 0.0;
  SmallSolve solve;
  const auto solve_inside = [&] {
    for (std::size_t k = 0; k < count; ++k) {
      members[k] = picked[inside[k]];
    }
    return solve.run(gram_, product_, {members.data(), count});
  };
  for (std::size_t round = 0; round < 3 * n; ++round) {
    std::size_t entering = n;
    double steepest = 1e-12 * std::sqrt(b_squared_);
    for (std::size_t k = 0; k < n; ++k) {
      if (x[k] != 0.0 || barred[k]) {
        continue;
      }
      double gradient = product_(picked[k]);
      for (std::size_t i = 0; i < count; ++i) {
        gradient -= gram_(picked[k], picked[inside[i]]) * x[inside[i]];
      }
      if (gradient > steepest) {
        steepest = gradient;
        entering = k;
      }
    }
    if (entering == n) {
      break;
    }
    inside[count++] = entering;
    if (!solve_inside() || !(solve.x[count - 1] > 0.0)) {  // depends on those already in
      --count;
      barred[entering] = true;
      continue;
    }
    while (!solve.positive && count > 0) {  // back to the first bound on the way; what reached it leaves
      double step = 1.0;
      for (std::size_t k = 0; k < count; ++k) {
        const double now = x[inside[k]];
        if (!(solve.x[k] > 0.0)) {
          step = std::min(step, now / (now - solve.x[k]));
        }
      }
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k) {
        double& now = x[inside[k]];
        const double moved = now + step * (solve.x[k] - now);
        now = solve.x[k] > 0.0 || moved > 1e-15 ? std::max(moved, 0.0) : 0.0;
        if (now > 0.0) {
          inside[kept++] = inside[k];
        }
      }
      if (kept == count) {
        break;
      }
      count = kept;
      if (!solve_inside()) {
        break;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      x[inside[k]] = std::max(solve.x[k], 0.0);
    }
    if (solve.positive) {
      gain = std::max(gain, solve.gain);
    }
  }
  return b_squared_ - gain;
}

SubsetSolution subset_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                    const Eigen::Ref<const Eigen::VectorXd>& b) {
  const GramProblem problem(a, b);
  std::vector<Eigen::Index> all(static_cast<std::size_t>(a.cols()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] = static_cast<Eigen::Index>(k);
  }
  SubsetSolution solution = problem.best_subset(all);
  std::vector<Eigen::Index> active;
  for (const Eigen::Index k : all) {
    if (solution.x(k) > 0.0) {
      active.push_back(k);
    }
  }
  if (!active.empty()) {  // the normal equations lose half the digits of nearly dependent columns; QR does not
    Eigen::MatrixXd columns(a.rows(), static_cast<Eigen::Index>(active.size()));
    Eigen::VectorXd length(static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      length(i) = a.col(active[k]).norm();
      columns.col(i) = a.col(active[k]) / length(i);
    }
    const Eigen::VectorXd exact = least_squares(columns, Eigen::VectorXd(b));
    if (exact.minCoeff() > 0.0) {
      for (std::size_t k = 0; k < active.size(); ++k) {
        solution.x(active[k]) = exact(static_cast<Eigen::Index>(k)) / length(static_cast<Eigen::Index>(k));
      }
    }
  }
  solution.squared_residual = (b - a * solution.x).squaredNorm();
  return solution;
}

}  // namespace driftlab
