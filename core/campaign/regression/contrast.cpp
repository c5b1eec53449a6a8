#include "core/campaign/regression/contrast.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kStructureSize = 0.01;

bool takes_part(const Session& session, std::optional<Arm> arm) {
  return arm ? session.arm == *arm : session.arm != Arm::History;
}

/// Weights of the sessions (columns) per row, which sum to 1 over those of an arm (of both arms: nothing); zero where
/// a session lacks the row.
Eigen::MatrixXd weights_of(const Design& design, const Eigen::VectorXd& scatter, std::optional<Arm> arm) {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(design.size(), static_cast<Eigen::Index>(design.sessions.size()));
  for (std::size_t s = 0; s < design.sessions.size(); ++s) {
    const Session& session = design.sessions[s];
    for (Eigen::Index row = 0; takes_part(session, arm) && row < design.size(); ++row) {
      if (session.has[static_cast<std::size_t>(row)]) {
        const std::size_t u = design.rows[static_cast<std::size_t>(row)].unit;
        const Eigen::Index in_unit = row - static_cast<Eigen::Index>(design.units[u].first);
        weights(row, static_cast<Eigen::Index>(s)) = 1.0 / ((*session.sampling)[u](in_unit, in_unit) + scatter(row));
      }
    }
  }
  for (Eigen::Index row = 0; row < design.size(); ++row) {
    if (const double sum = weights.row(row).sum(); sum > 0.0) {
      weights.row(row) /= sum;
    }
  }
  return weights;
}

Eigen::VectorXd weighted(const Design& design, const Eigen::MatrixXd& weights) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(design.size());
  for (std::size_t s = 0; s < design.sessions.size(); ++s) {
    for (Eigen::Index row = 0; row < design.size(); ++row) {
      if (const double weight = weights(row, static_cast<Eigen::Index>(s)); weight != 0.0) {
        sum(row) += weight * design.sessions[s].x(row);
      }
    }
  }
  return sum;
}

/// sum_r w_r w_r' S_r/4, element by element.
Eigen::MatrixXd sampling_of(const Design& design, const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(design.size(), design.size());
  for (std::size_t s = 0; s < design.sessions.size(); ++s) {
    for (std::size_t u = 0; u < design.units.size(); ++u) {
      const auto first = static_cast<Eigen::Index>(design.units[u].first);
      const auto count = static_cast<Eigen::Index>(design.units[u].count);
      const Eigen::VectorXd w = weights.col(static_cast<Eigen::Index>(s)).segment(first, count);
      sum.block(first, first, count, count) += (w * w.transpose()).cwiseProduct((*design.sessions[s].sampling)[u]);
    }
  }
  return sum;
}

/// The squares of a row's weights over their sum, for the sessions of both arms by rising shares: their order in the
/// design does not matter.
Eigen::MatrixXd shares_of(const Design& design, const Eigen::MatrixXd& weights) {
  std::vector<Eigen::Index> compared;
  for (std::size_t s = 0; s < design.sessions.size(); ++s) {
    if (takes_part(design.sessions[s], std::nullopt)) {
      compared.push_back(static_cast<Eigen::Index>(s));
    }
  }
  Eigen::MatrixXd shares = weights(Eigen::all, compared).cwiseAbs2();
  for (Eigen::Index row = 0; row < shares.rows(); ++row) {
    if (const double sum = shares.row(row).sum(); sum > 0.0) {
      shares.row(row) /= sum;
    }
  }
  std::vector<Eigen::Index> order(compared.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::lexicographical_compare(shares.col(a).begin(), shares.col(a).end(), shares.col(b).begin(),
                                        shares.col(b).end());
  });
  return shares(Eigen::all, order);
}

/// The rows of one unit among those that are tested, as places in the list of tests.
std::vector<Eigen::Index> tests_of(const std::vector<Test>& tests, std::size_t unit) {
  std::vector<Eigen::Index> places;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    if (tests[t].unit == unit && !tests[t].level) {
      places.push_back(static_cast<Eigen::Index>(t));
    }
  }
  return places;
}

double chi_square_p(const Eigen::VectorXd& residual, const Eigen::MatrixXd& covariance, double dof) {
  return dof >= 1.0 ? chi_squared_tail(residual.dot(solve_symmetric(covariance, residual)), dof) : 1.0;
}

/// A unit's levels as functions of its scales, or nothing where its structure does not hold.
struct LevelEstimator {
  StructureTest structure;
  Eigen::MatrixXd of_scales;  ///< levels x scales of the unit
};

LevelEstimator estimate_levels(const Unit& unit, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                               const Eigen::VectorXd& misfit, const Eigen::MatrixXd& pooled,
                               const Eigen::MatrixXd& sensitivity) {
  LevelEstimator estimator;
  const auto scales = static_cast<double>(theta.size());
  const auto levels = static_cast<double>(unit.levels.size());
  if (unit.levels.empty() || scales <= levels) {
    return estimator;
  }
  const Eigen::MatrixXd weighed = solve_symmetric(covariance, sensitivity);  // C^-1 D
  const Eigen::MatrixXd information = sensitivity.transpose() * weighed;
  const Eigen::MatrixXd transposed = weighed.transpose();
  estimator.of_scales = solve_symmetric(information, transposed);
  const Eigen::VectorXd unexplained = theta - sensitivity * (estimator.of_scales * theta);
  estimator.structure.p_contrast = chi_square_p(unexplained, covariance, scales - levels);
  estimator.structure.p_fit = chi_square_p(misfit, pooled, scales - levels - static_cast<double>(unit.shapes));
  estimator.structure.compared = estimator.of_scales.allFinite() && estimator.structure.p_fit >= kStructureSize &&
                                 estimator.structure.p_contrast >= kStructureSize;
  return estimator;
}

/// The mean of an arm at each row. `scatter`: what a session adds, per row.
std::vector<ArmMean> means_of(const Design& design, const Eigen::MatrixXd& weights, const Eigen::VectorXd& scatter) {
  const Eigen::VectorXd x = weighted(design, weights);
  const Eigen::VectorXd sampling = sampling_of(design, weights).diagonal();
  std::vector<ArmMean> means;
  for (Eigen::Index row = 0; row < design.size(); ++row) {
    means.push_back({x(row), std::sqrt(sampling(row) + weights.row(row).squaredNorm() * scatter(row))});
  }
  return means;
}

}  // namespace

Contrast make_contrast(const Design& design, const ScatterTerms& terms, const SessionScatter& scatter) {
  Contrast contrast;
  const Eigen::MatrixXd mean_scatter =
      scatter.mean_square_common() * terms.common + scatter.mean_square_local() * terms.local;
  const Eigen::MatrixXd base = weights_of(design, mean_scatter.diagonal(), Arm::Baseline);
  const Eigen::MatrixXd candidate = weights_of(design, mean_scatter.diagonal(), Arm::Candidate);
  const std::vector<ArmMean> before = means_of(design, base, mean_scatter.diagonal());
  const std::vector<ArmMean> after = means_of(design, candidate, mean_scatter.diagonal());
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < design.size(); ++row) {
    if (base.row(row).sum() > 0.0 && candidate.row(row).sum() > 0.0) {
      const Row& scale = design.rows[static_cast<std::size_t>(row)];
      rows.push_back(row);
      contrast.tests.push_back({scale.unit, std::nullopt, row, scale.tau_s, scale.margin});
      contrast.means.push_back({before[static_cast<std::size_t>(row)], after[static_cast<std::size_t>(row)]});
    }
  }
  const Eigen::MatrixXd weights = candidate - base;
  const Eigen::MatrixXd shared = (weights * weights.transpose())(rows, rows);
  const Eigen::VectorXd theta = weighted(design, weights)(rows);
  contrast.shares = shares_of(design, weights)(rows, Eigen::all);
  contrast.sampling = sampling_of(design, weights)(rows, rows);
  contrast.common = shared.cwiseProduct(terms.common(rows, rows));
  contrast.local = shared.cwiseProduct(terms.local(rows, rows));
  const Eigen::MatrixXd covariance =
      contrast.sampling + scatter.mean_square_common() * contrast.common + scatter.mean_square_local() * contrast.local;

  const Eigen::MatrixXd both = weights_of(design, mean_scatter.diagonal(), std::nullopt);
  const Eigen::VectorXd pooled_x = weighted(design, both)(rows);
  const Eigen::MatrixXd pooled =
      sampling_of(design, both)(rows, rows) + (both * both.transpose()).cwiseProduct(mean_scatter)(rows, rows);

  std::vector<std::pair<std::vector<Eigen::Index>, Eigen::MatrixXd>> estimators;
  Eigen::Index levels = 0;
  const auto scales = static_cast<Eigen::Index>(rows.size());
  for (std::size_t u = 0; u < design.units.size(); ++u) {
    const Unit& unit = design.units[u];
    const std::vector<Eigen::Index> places = tests_of(contrast.tests, u);
    LevelEstimator found;
    if (!unit.levels.empty() && !places.empty()) {
      std::vector<Eigen::Index> in_unit;
      for (const Eigen::Index place : places) {
        in_unit.push_back(contrast.tests[static_cast<std::size_t>(place)].row - static_cast<Eigen::Index>(unit.first));
      }
      const Eigen::VectorXd misfit = pooled_x(places) - unit.modelled(in_unit);
      found = estimate_levels(unit, theta(places), covariance(places, places), misfit, pooled(places, places),
                              unit.sensitivity(in_unit, Eigen::all));
    }
    contrast.structures.push_back(found.structure);
    if (!found.structure.compared) {
      continue;
    }
    for (std::size_t level = 0; level < unit.levels.size(); ++level) {
      contrast.tests.push_back({u, level, 0, 0.0, unit.levels[level].margin});
    }
    levels += found.of_scales.rows();
    estimators.emplace_back(places, std::move(found.of_scales));
  }
  contrast.combine = Eigen::MatrixXd::Zero(scales + levels, scales);
  contrast.combine.topRows(scales).setIdentity();
  Eigen::Index next = scales;
  for (const auto& [places, of_scales] : estimators) {
    contrast.combine(Eigen::seqN(next, of_scales.rows()), places) = of_scales;
    next += of_scales.rows();
  }
  contrast.theta = contrast.combine * theta;
  contrast.se = (contrast.combine * covariance * contrast.combine.transpose()).diagonal().cwiseSqrt();
  return contrast;
}

}  // namespace driftlab::regression
