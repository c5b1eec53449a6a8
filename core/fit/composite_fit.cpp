#include "core/fit/composite_fit.hpp"

#include "core/fit/discrepancy.hpp"
#include "core/process/dense.hpp"
#include "core/process/model.hpp"
#include "core/variance/kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab {
namespace {

constexpr int kMaxIterations = 60;
/// Fall of L at which an iteration is the last one.
constexpr double kEnough = 1e-3;
/// 1/sd of a held value: it moves L by less than 0.001 when it is off by 3e-6 of the logarithm.
constexpr double kHold = 1e4;
/// How far from the estimate the end of an interval is looked for.
constexpr double kOpen = 20.0;
/// The largest step of a coordinate.
constexpr double kLongest = 3.0;

using Of = CompositeQuantity::Of;

std::optional<Of> part(const CompositeQuantity& quantity, std::size_t component) {
  for (std::size_t i = 0; i < quantity.components.size(); ++i) {
    if (quantity.components[i] == component) {
      return quantity.of[i];
    }
  }
  return std::nullopt;
}

double contribution(Of of, const Component& component, double log_density) {
  const double more = of == Of::Density ? log_density : of == Of::Walk ? std::log(2.0) + component.log_shape[0] : 0.0;
  return std::exp(component.log_square + more);
}

}  // namespace

struct CompositeDistance::Point {
  Eigen::VectorXd residual;  ///< whitened; then the constraint
  Eigen::MatrixXd jacobian;
  double squared = 0.0;   ///< of all rows
  double distance = 0.0;  ///< without the constraint
};

/// The columns of a model's components, kept while a component keeps its shapes.
struct CompositeDistance::Columns {
  struct Known {
    Component at;
    LogColumn column;
    bool slopes = false;
    bool valid = false;
  };
  std::vector<Known> known;
  std::size_t settled = 0;  ///< components whose slopes nobody asks for
  Eigen::MatrixXd raw;      ///< ln of the curve less that of the model, then its derivatives
  Eigen::MatrixXd whitened;

  const LogColumn& of(const CompositeBasis& basis, const Component& component, std::size_t c, bool slopes) {
    known.resize(std::max(known.size(), c + 1));
    Known& one = known[c];
    slopes = slopes && c >= settled;
    if (!one.valid || one.at.kind != component.kind || one.at.log_shape != component.log_shape ||
        (slopes && !one.slopes)) {
      basis.column(component, slopes, one.column);
      one = {component, std::move(one.column), slopes, true};
    }
    return one.column;
  }
};

std::size_t parameter_count(const CompositeBasis& basis, const Composite& model) {
  std::size_t count = 0;
  for (const Component& component : model) {
    count += 1 + basis.kinds()[component.kind].shapes();
  }
  return count;
}

std::string composite_name(const CompositeBasis& basis, const Composite& model) {
  std::vector<std::size_t> kinds;
  for (const Component& component : model) {
    kinds.push_back(component.kind);
  }
  std::sort(kinds.begin(), kinds.end());
  ModelStructure structure;
  for (const std::size_t kind : kinds) {
    structure.kinds.push_back(basis.kinds()[kind].kind);
  }
  return model_name(structure);
}

CompositeDistance::CompositeDistance(const CompositeBasis& basis, const CurveCovariance& curve, double delta)
    : basis_(&basis),
      used_(curve.used),
      y_(curve.log_variance),
      whitening_(discrepancy_whitening(curve.covariance.whole(), delta)),
      delta_(delta) {}

void CompositeDistance::evaluate(const Composite& model, const std::optional<CompositeConstraint>& constraint,
                                 bool slopes, Columns& columns, Point& point) const {
  const Eigen::Index rows = y_.size();
  const Eigen::Index zero = basis_->table().scales();  // the row of the density at frequency 0
  const auto parameters = static_cast<Eigen::Index>(parameter_count(*basis_, model));
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(rows);
  Eigen::RowVectorXd held_slope = Eigen::RowVectorXd::Zero(parameters);
  double held = 0.0;
  Eigen::MatrixXd& raw = columns.raw;
  raw.resize(rows, 1 + (slopes ? parameters : 0));
  Eigen::Index k = 1;
  for (std::size_t c = 0; c < model.size(); ++c) {
    const LogColumn& column = columns.of(*basis_, model[c], c, slopes);
    const Eigen::VectorXd share = (column.value(used_).array() + model[c].log_square).exp();
    sum += share;
    const std::optional<Of> of = constraint ? part(constraint->quantity, c) : std::nullopt;
    const double level = of ? contribution(*of, model[c], column.value(zero)) : 0.0;
    held += level;
    if (slopes) {
      raw.col(k) = share;
      held_slope(k - 1) = level;
      for (std::size_t s = 0; s < basis_->kinds()[model[c].kind].shapes(); ++s) {
        const auto place = k + 1 + static_cast<Eigen::Index>(s);
        if (c < columns.settled) {
          raw.col(place).setZero();
          continue;
        }
        raw.col(place) = share.cwiseProduct(column.slope[s](used_));
        held_slope(place - 1) = of == Of::Density          ? level * column.slope[s](zero)
                                : of == Of::Walk && s == 0 ? level
                                                           : 0.0;
      }
    }
    k += 1 + static_cast<Eigen::Index>(basis_->kinds()[model[c].kind].shapes());
  }
  const Eigen::Index all = rows + (constraint ? 1 : 0);
  raw.col(0) = y_.array() - sum.array().log();
  for (Eigen::Index p = 1; p < raw.cols(); ++p) {
    raw.col(p).array() /= -sum.array();
  }
  columns.whitened.resize(rows, raw.cols());
  kernels().lower_product(whitening_.data(), static_cast<std::size_t>(rows), raw.data(),
                          static_cast<std::size_t>(raw.cols()), columns.whitened.data());
  point.residual.resize(all);
  point.residual.head(rows) = columns.whitened.col(0);
  point.distance = point.residual.head(rows).squaredNorm();
  if (slopes) {
    point.jacobian.resize(all, parameters);
    point.jacobian.topRows(rows) = columns.whitened.rightCols(parameters);
  }
  if (constraint) {
    point.residual(rows) = kHold * (std::log(held) - constraint->value);
    if (slopes) {
      point.jacobian.row(rows) = kHold / held * held_slope;
    }
  }
  point.squared = point.residual.squaredNorm();
}

double CompositeDistance::at(const Composite& model) const {
  Point point;
  Columns columns;
  evaluate(model, std::nullopt, false, columns, point);
  return point.distance;
}

double CompositeDistance::value(const Composite& model, const CompositeQuantity& quantity) const {
  LogColumn column;
  double sum = 0.0;
  for (std::size_t i = 0; i < quantity.components.size(); ++i) {
    const Component& component = model[quantity.components[i]];
    basis_->column(component, false, column);
    sum += contribution(quantity.of[i], component, column.value(basis_->table().scales()));
  }
  return std::log(sum);
}

double CompositeDistance::standard_error(const Composite& model, const CompositeQuantity& quantity) const {
  Point point;
  Columns columns;
  evaluate(model, CompositeConstraint{quantity, value(model, quantity)}, true, columns, point);
  const Eigen::Index rows = y_.size();
  const Eigen::VectorXd gradient = point.jacobian.row(rows).transpose() / kHold;
  const Eigen::MatrixXd free = point.jacobian.topRows(rows);
  const SymmetricEigen eigen = symmetric_eigen(free.transpose() * free);
  double variance = 0.0;
  for (Eigen::Index e = 0; e < gradient.size(); ++e) {
    const double loading = eigen.vectors.col(e).dot(gradient);
    variance += loading * loading / std::max(eigen.values(e), 1e-10);
  }
  return std::sqrt(variance);
}

Eigen::VectorXd CompositeDistance::standard_errors(const Composite& model) const {
  Point point;
  Columns columns;
  evaluate(model, std::nullopt, true, columns, point);
  const SymmetricEigen eigen = symmetric_eigen(point.jacobian.transpose() * point.jacobian);
  Eigen::VectorXd errors(eigen.values.size());
  for (Eigen::Index k = 0; k < errors.size(); ++k) {
    errors(k) = std::sqrt((eigen.vectors.row(k).transpose().array().square() / eigen.values.array().max(1e-10)).sum());
  }
  return errors;
}

Interval CompositeDistance::profile(const Composite& model, const CompositeQuantity& quantity, double rise) const {
  const double best = value(model, quantity);
  const double least = at(model);
  const double wanted = std::sqrt(rise);
  const double guess = std::clamp(wanted * standard_error(model, quantity), 1e-4, 2.0);
  Interval interval{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (const double direction : {-1.0, 1.0}) {
    double inside = 0.0;  // steps from the estimate, and the roots of how far L has risen there
    double inside_root = 0.0;
    double outside = 0.0;
    double outside_root = 0.0;
    Composite warm = model;
    const auto root_at = [&](double step) {
      return std::sqrt(std::max(minimise(warm, CompositeConstraint{quantity, best + direction * step}) - least, 0.0));
    };
    bool found = false;
    for (double step = guess; !found && inside < kOpen; step *= 2.0) {
      outside = inside + step;
      outside_root = root_at(outside);
      found = outside_root > wanted;
      if (!found) {
        inside = outside;
        inside_root = outside_root;
      }
    }
    if (!found) {
      continue;
    }
    for (int i = 0; i < 12 && outside - inside > 1e-2 * outside; ++i) {
      const double fraction = std::clamp((wanted - inside_root) / (outside_root - inside_root), 0.1, 0.9);
      const double middle = inside + fraction * (outside - inside);
      const double root = root_at(middle);
      (root > wanted ? outside : inside) = middle;
      (root > wanted ? outside_root : inside_root) = root;
      if (std::fabs(root - wanted) < 0.02) {
        outside = inside = middle;
      }
    }
    (direction < 0.0 ? interval.low : interval.high) = best + direction * outside;
  }
  return interval;
}

double CompositeDistance::minimise(Composite& model, const std::optional<CompositeConstraint>& constraint,
                                   std::size_t settled) const {
  Point point;
  Columns columns;
  columns.settled = settled;
  evaluate(model, constraint, true, columns, point);
  double damping = 1e-3;
  Composite trial = model;
  Point next;
  Eigen::MatrixXd normal;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    normal.resize(point.jacobian.cols(), point.jacobian.cols());
    kernels().gram(point.jacobian.data(), static_cast<std::size_t>(point.jacobian.rows()),
                   static_cast<std::size_t>(point.jacobian.cols()), normal.data());
    Eigen::VectorXd gradient = point.jacobian.transpose() * point.residual;
    // A shape that stands at an end of its range and would leave it is held there.
    Eigen::Index k = 0;
    for (std::size_t c = 0; c < model.size(); ++c) {
      const Component& component = model[c];
      ++k;
      for (std::size_t s = 0; s < basis_->kinds()[component.kind].shapes(); ++s, ++k) {
        const auto [low, high] = basis_->range(component, s);
        if (c < settled || (component.log_shape[s] <= low && gradient(k) > 0.0) ||
            (component.log_shape[s] >= high && gradient(k) < 0.0)) {
          gradient(k) = 0.0;
          normal.row(k).setZero();
          normal.col(k).setZero();
          normal(k, k) = 1.0;
        }
      }
    }
    bool better = false;
    double fall = 0.0;
    for (; damping < 1e8 && !better; damping *= 8.0) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal().array() += damping * normal.diagonal().array() + 1e-9;
      const Eigen::VectorXd step = solve_symmetric(damped, gradient);
      if (!step.allFinite()) {
        continue;
      }
      k = 0;
      for (std::size_t c = 0; c < model.size(); ++c) {
        trial[c].log_square = model[c].log_square - std::clamp(step(k), -kLongest, kLongest);
        ++k;
        for (std::size_t s = 0; s < basis_->kinds()[model[c].kind].shapes(); ++s, ++k) {
          const auto [low, high] = basis_->range(model[c], s);
          trial[c].log_shape[s] =
              std::clamp(model[c].log_shape[s] - std::clamp(step(k), -kLongest, kLongest), low, high);
        }
      }
      evaluate(trial, constraint, true, columns, next);
      better = next.squared < point.squared;
      fall = point.squared - next.squared;
    }
    if (!better) {
      break;
    }
    std::swap(model, trial);
    trial = model;
    std::swap(point, next);
    damping = std::max(damping / 8.0 / 10.0, 1e-7);
    if (fall < kEnough) {
      break;
    }
  }
  return point.distance;
}

}  // namespace driftlab
