#include "core/campaign/regression/release_trend.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr std::size_t kFewestReleases = 3;
constexpr double kConfidence = 0.05;

/// The mean of a release's sessions over some rows, and its covariance in three parts: C = sampling + kL^2 common +
/// kS^2 local.
struct ReleaseMean {
  double position = 0.0;
  Eigen::VectorXd x;
  Eigen::MatrixXd sampling;
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;

  [[nodiscard]] Eigen::MatrixXd covariance(double common_square, double local_square) const {
    return sampling + common_square * common + local_square * local;
  }
  /// As seen through linear functions of the rows.
  [[nodiscard]] ReleaseMean through(const Eigen::MatrixXd& functions) const {
    const auto both = [&](const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
      return functions * matrix * functions.transpose();
    };
    return {position, functions * x, both(sampling), both(common), both(local)};
  }
};

using Places = std::vector<Eigen::Index>;

bool reaches(const Session& session, const Places& rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](Eigen::Index row) { return session.has[static_cast<std::size_t>(row)]; });
}

/// Means over `rows` of one unit, by position; sessions that lack a row take no part.
std::vector<ReleaseMean> means_of(const Design& design, const ScatterTerms& terms, const SessionScatter& scatter,
                                  const ReleaseOrder& order, std::size_t unit, const Places& rows) {
  std::map<double, std::vector<const Session*>> releases;
  for (std::size_t s = 0; s < design.sessions.size(); ++s) {
    if (reaches(design.sessions[s], rows)) {
      releases[order.position[s]].push_back(&design.sessions[s]);
    }
  }
  Places in_unit;
  for (const Eigen::Index row : rows) {
    in_unit.push_back(row - static_cast<Eigen::Index>(design.units[unit].first));
  }
  const Eigen::MatrixXd common = terms.common(rows, rows);
  const Eigen::MatrixXd local = terms.local(rows, rows);
  const Eigen::VectorXd between =
      (scatter.mean_square_common() * common + scatter.mean_square_local() * local).diagonal();
  std::vector<ReleaseMean> means;
  for (const auto& [position, sessions] : releases) {
    const auto count = static_cast<Eigen::Index>(rows.size());
    ReleaseMean mean{position, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count), {}, {}};
    Eigen::MatrixXd weights(count, static_cast<Eigen::Index>(sessions.size()));
    for (std::size_t s = 0; s < sessions.size(); ++s) {
      const Eigen::MatrixXd& sampling = (*sessions[s]->sampling)[unit];
      weights.col(static_cast<Eigen::Index>(s)) = (sampling.diagonal()(in_unit) + between).cwiseInverse();
    }
    const Eigen::VectorXd sum = weights.rowwise().sum();
    weights.array().colwise() /= sum.array();
    for (std::size_t s = 0; s < sessions.size(); ++s) {
      const Eigen::VectorXd w = weights.col(static_cast<Eigen::Index>(s));
      mean.x += w.cwiseProduct(sessions[s]->x(rows));
      mean.sampling += (w * w.transpose()).cwiseProduct((*sessions[s]->sampling)[unit](in_unit, in_unit));
    }
    const Eigen::MatrixXd shared = weights * weights.transpose();
    mean.common = shared.cwiseProduct(common);
    mean.local = shared.cwiseProduct(local);
    means.push_back(std::move(mean));
  }
  return means;
}

/// Var of the slope at each point of the factors' grid.
using GridVariance = Eigen::Matrix<double, kFactors, kFactors>;

/// P(|slope| as far from `at` or further), mixed over the posterior.
double two_sided(const SessionScatter& scatter, const GridVariance& variance, double distance) {
  double p = 0.0;
  for (Eigen::Index a = 0; a < variance.rows(); ++a) {
    for (Eigen::Index b = 0; b < variance.cols(); ++b) {
      p += scatter.posterior(a, b) * std::erfc(distance / std::sqrt(2.0 * variance(a, b)));
    }
  }
  return p;
}

/// The regression; nothing where the releases do not determine it.
std::optional<ReleaseTrend> regress(const std::vector<ReleaseMean>& means, const SessionScatter& scatter,
                                    const ReleaseOrder& order) {
  if (means.size() < kFewestReleases) {
    return std::nullopt;
  }
  const Eigen::Index rows = means.front().x.size();
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(rows);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
  double d = 0.0;
  std::vector<Eigen::MatrixXd> inverse;
  for (const ReleaseMean& mean : means) {
    const Eigen::MatrixXd covariance = mean.covariance(scatter.mean_square_common(), scatter.mean_square_local());
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(rows, rows);
    inverse.push_back(solve_symmetric(covariance, identity));
    a += inverse.back();
    b += mean.position * (inverse.back() * ones);
    d += mean.position * mean.position * ones.dot(inverse.back() * ones);
  }
  const Eigen::VectorXd levels = solve_symmetric(a, b);
  const double information = d - b.dot(levels);
  if (!(information > 0.0) || !std::isfinite(information)) {
    return std::nullopt;
  }
  ReleaseTrend trend;
  trend.releases = means.size();
  GridVariance variance = GridVariance::Zero();
  const auto& grid = factor_grid();
  for (std::size_t l = 0; l < means.size(); ++l) {
    const Eigen::VectorXd weight = inverse[l] * (means[l].position * ones - levels) / information;
    trend.slope += weight.dot(means[l].x);
    const double sampling = weight.dot(means[l].sampling * weight);
    const double common = weight.dot(means[l].common * weight);
    const double local = weight.dot(means[l].local * weight);
    for (std::size_t i = 0; i < kFactors; ++i) {
      for (std::size_t j = 0; j < kFactors; ++j) {
        variance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
            sampling + grid[i] * grid[i] * common + grid[j] * grid[j] * local;
      }
    }
  }
  trend.p = two_sided(scatter, variance, std::fabs(trend.slope));
  double low = 0.0;
  double high = 10.0 * std::sqrt(variance.maxCoeff());
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (two_sided(scatter, variance, middle) > kConfidence ? low : high) = middle;
  }
  trend.ci95 = {trend.slope - high, trend.slope + high};
  trend.total = trend.slope * (order.candidate - order.anchor);
  return trend;
}

/// Rows that the tests of a unit's scales stand for, in their order.
Places tested_rows(const Contrast& contrast, std::size_t unit, Places& columns) {
  Places rows;
  for (std::size_t t = 0; t < contrast.tests.size(); ++t) {
    if (contrast.tests[t].unit == unit && !contrast.tests[t].level) {
      rows.push_back(contrast.tests[t].row);
      columns.push_back(static_cast<Eigen::Index>(t));
    }
  }
  return rows;
}

bool is_white(const Level& level) {
  const ProcessKind* const kind = find_process(level.process);
  return kind != nullptr && kind->white_square != nullptr;
}

}  // namespace

std::vector<ReleaseTrend> release_trends(const Design& design, const ScatterTerms& terms, const SessionScatter& scatter,
                                         const Contrast& contrast, const ReleaseOrder& order, double through_s) {
  std::vector<ReleaseTrend> trends;
  const auto keep = [&](std::optional<ReleaseTrend> trend, std::size_t unit, std::optional<std::size_t> level) {
    if (trend) {
      trend->unit = unit;
      trend->level = level;
      trends.push_back(*trend);
    }
  };
  for (std::size_t u = 0; u < design.units.size(); ++u) {
    Places columns;
    const Places tested = tested_rows(contrast, u, columns);
    Places rows;
    std::copy_if(tested.begin(), tested.end(), std::back_inserter(rows),
                 [&](Eigen::Index row) { return design.rows[static_cast<std::size_t>(row)].tau_s <= through_s; });
    if (rows.empty()) {
      continue;
    }
    keep(regress(means_of(design, terms, scatter, order, u, rows), scatter, order), u, std::nullopt);
    for (std::size_t t = 0; t < contrast.tests.size(); ++t) {
      const Test& test = contrast.tests[t];
      if (test.unit != u || !test.level || !is_white(design.units[u].levels[*test.level])) {
        continue;
      }
      const Eigen::MatrixXd function = contrast.combine(Places{static_cast<Eigen::Index>(t)}, columns);
      std::vector<ReleaseMean> means;
      for (const ReleaseMean& mean : means_of(design, terms, scatter, order, u, tested)) {
        means.push_back(mean.through(function));
      }
      keep(regress(means, scatter, order), u, test.level);
    }
  }
  return trends;
}

}  // namespace driftlab::regression
