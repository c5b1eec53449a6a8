#include "core/campaign/trends.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace driftlab {
namespace {

constexpr double kSize = 0.05;
constexpr double kLeastExponent = 0.1;
constexpr double kMostExponent = 10.0;
constexpr int kExponents = 10;

/// The points on the scale of the model.
struct Series {
  Eigen::VectorXd at;  ///< w over the largest w
  Eigen::VectorXd y;
  Eigen::VectorXd variance;

  [[nodiscard]] Eigen::Index size() const { return y.size(); }
};

Series series_of(const std::vector<TrendPoint>& points) {
  Series series;
  const auto n = static_cast<Eigen::Index>(points.size());
  series.at.resize(n);
  series.y.resize(n);
  series.variance.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TrendPoint& point = points[static_cast<std::size_t>(i)];
    series.at(i) = point.at / points.back().at;
    series.y(i) = std::log(point.estimate.value);
    const double sd = std::log(point.estimate.ci95.high / point.estimate.ci95.low) / (2.0 * kNormal975);
    series.variance(i) = sd * sd;
  }
  return series;
}

/// Weighted least squares y ~ X b.
struct Regression {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  double chi_square = 0.0;
};

Regression regress(const Eigen::MatrixXd& design, const Eigen::VectorXd& y, const Eigen::VectorXd& variance) {
  const Eigen::VectorXd weight = variance.cwiseInverse();
  const Eigen::MatrixXd normal = design.transpose() * weight.asDiagonal() * design;
  Regression result;
  result.covariance = inverse(normal);
  result.coefficients = result.covariance * (design.transpose() * weight.cwiseProduct(y));
  const Eigen::VectorXd residual = y - design * result.coefficients;
  result.chi_square = weight.dot(residual.cwiseAbs2());
  return result;
}

/// The tau^2 at which the weighted residual square equals its degrees of freedom (Paule and Mandel 1982); 0 where it is
/// less from the start.
double paule_mandel(const Eigen::MatrixXd& design, const Series& series) {
  const auto dof = static_cast<double>(series.size() - design.cols());
  const auto excess = [&](double tau2) {
    return regress(design, series.y, series.variance.array() + tau2).chi_square - dof;
  };
  if (excess(0.0) <= 0.0) {
    return 0.0;
  }
  double low = 0.0;
  double high = series.variance.maxCoeff();
  while (excess(high) > 0.0) {
    high *= 4.0;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Ranks of `at`, ties shared.
Eigen::VectorXd ranks(const Eigen::VectorXd& at) {
  Eigen::VectorXd rank(at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const auto below = static_cast<double>((at.array() < at(i)).count());
    const auto equal = static_cast<double>((at.array() == at(i)).count());
    rank(i) = below + 0.5 * (equal - 1.0);
  }
  return rank;
}

void test_monotone(const Series& series, Trend& trend) {
  Eigen::MatrixXd design(series.size(), 2);
  design.col(0).setOnes();
  design.col(1) = ranks(series.at);
  trend.few = series.size() < 4;
  if (trend.few) {
    const Regression fit = regress(design, series.y, series.variance);
    trend.monotone_statistic = fit.coefficients(1) / std::sqrt(fit.covariance(1, 1));
    trend.monotone_p = 2.0 * normal_tail(std::fabs(trend.monotone_statistic));
  } else {
    const double tau2 = paule_mandel(design, series);
    const Regression fit = regress(design, series.y, series.variance.array() + tau2);
    const auto dof = static_cast<double>(series.size() - 2);
    const double scale = std::max(1.0, fit.chi_square / dof);
    trend.monotone_statistic = fit.coefficients(1) / std::sqrt(scale * fit.covariance(1, 1));
    trend.monotone_p = 2.0 * student_tail(std::fabs(trend.monotone_statistic), dof);
  }
  if (trend.monotone_p < kSize) {
    trend.direction = trend.monotone_statistic > 0.0 ? 1 : -1;
  }
}

/// Shape of the relation: f = low + (high - low) s, s = at^exponent, and the gradient of ln f by (ln low, ln high).
struct Curve {
  Eigen::VectorXd ln_f;
  Eigen::MatrixXd gradient;
};

Curve curve_of(const Eigen::VectorXd& share, double ln_low, double ln_high) {
  Curve curve{Eigen::VectorXd(share.size()), Eigen::MatrixXd(share.size(), 2)};
  const double low = std::exp(ln_low);
  const double high = std::exp(ln_high);
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    const double from_low = low * (1.0 - share(i));
    const double from_high = high * share(i);
    curve.ln_f(i) = std::log(from_low + from_high);
    curve.gradient(i, 0) = from_low / (from_low + from_high);
    curve.gradient(i, 1) = from_high / (from_low + from_high);
  }
  return curve;
}

struct ShapeFit {
  double ln_low = 0.0;
  double ln_high = 0.0;
  double chi_square = std::numeric_limits<double>::infinity();
};

/// Gauss-Newton over (ln low, ln high) with halved steps; the problem is nearly linear.
ShapeFit fit_shape(const Series& series, const Eigen::VectorXd& share, const Eigen::VectorXd& variance) {
  const Eigen::VectorXd weight = variance.cwiseInverse();
  const auto distance = [&](double ln_low, double ln_high) {
    return weight.dot((series.y - curve_of(share, ln_low, ln_high).ln_f).cwiseAbs2());
  };
  ShapeFit fit;
  fit.ln_low = series.y(0);
  fit.ln_high = series.y(series.size() - 1);
  fit.chi_square = distance(fit.ln_low, fit.ln_high);
  for (int round = 0; round < 50; ++round) {
    const Curve curve = curve_of(share, fit.ln_low, fit.ln_high);
    Eigen::MatrixXd normal = curve.gradient.transpose() * weight.asDiagonal() * curve.gradient;
    normal.diagonal().array() += 1e-9 * normal.trace();
    const Eigen::VectorXd right = curve.gradient.transpose() * weight.cwiseProduct(series.y - curve.ln_f);
    const Eigen::VectorXd step = solve_symmetric(normal, right);
    double length = 1.0;
    double next = distance(fit.ln_low + step(0), fit.ln_high + step(1));
    while (!(next <= fit.chi_square) && length > 1e-4) {
      length *= 0.5;
      next = distance(fit.ln_low + length * step(0), fit.ln_high + length * step(1));
    }
    if (!(next < fit.chi_square)) {
      break;
    }
    const bool done = fit.chi_square - next < 1e-10 * (1.0 + next);
    fit.ln_low += length * step(0);
    fit.ln_high += length * step(1);
    fit.chi_square = next;
    if (done) {
      break;
    }
  }
  return fit;
}

/// The relation at given tau^2, and -2 ln likelihood of it.
struct RelationFit {
  ShapeFit shape;
  double exponent = 1.0;
  double deviance = std::numeric_limits<double>::infinity();
};

enum class Search { Coarse, Fine };

RelationFit fit_at(const Series& series, Relation relation, double tau2, Search search) {
  const Eigen::VectorXd variance = series.variance.array() + tau2;
  RelationFit fit;
  if (relation == Relation::Constant) {
    const Regression mean = regress(Eigen::MatrixXd::Ones(series.size(), 1), series.y, variance);
    fit.shape = {mean.coefficients(0), mean.coefficients(0), mean.chi_square};
  } else if (relation == Relation::Linear) {
    fit.shape = fit_shape(series, series.at, variance);
  } else {
    const auto visit = [&](double ln_exponent) {
      const double exponent = std::exp(ln_exponent);
      const ShapeFit shape = fit_shape(series, series.at.array().pow(exponent).matrix(), variance);
      if (shape.chi_square < fit.shape.chi_square) {
        fit.shape = shape;
        fit.exponent = exponent;
      }
    };
    const double low = std::log(kLeastExponent);
    const double high = std::log(kMostExponent);
    double step = (high - low) / kExponents;
    for (int g = 0; g <= kExponents; ++g) {
      visit(low + g * step);
    }
    for (; search == Search::Fine && step > 0.005; step *= 0.5) {
      const double centre = std::log(fit.exponent);
      visit(std::max(low, centre - 0.5 * step));
      visit(std::min(high, centre + 0.5 * step));
    }
  }
  fit.deviance = fit.shape.chi_square + variance.array().log().sum();
  return fit;
}

std::size_t parameters_of(Relation relation) { return static_cast<std::size_t>(relation) + 1; }

/// Covariance of (ln low, ln high, ln exponent) at the fit.
void store_covariance(const Series& series, double tau2, FittedRelation& relation) {
  const Eigen::VectorXd share = series.at.array().pow(relation.exponent);
  const Curve curve = curve_of(share, std::log(relation.low), std::log(relation.high));
  const auto count = static_cast<Eigen::Index>(parameters_of(relation.relation));
  Eigen::MatrixXd gradient(series.size(), count);
  if (relation.relation == Relation::Constant) {
    gradient.setOnes();
  } else {
    gradient.leftCols(2) = curve.gradient;
    if (relation.relation == Relation::Power) {
      for (Eigen::Index i = 0; i < series.size(); ++i) {
        const double slope = share(i) > 0.0 ? share(i) * std::log(series.at(i)) * relation.exponent : 0.0;
        gradient(i, 2) = (relation.high - relation.low) * slope / std::exp(curve.ln_f(i));
      }
    }
  }
  const Eigen::VectorXd weight = (series.variance.array() + tau2).inverse();
  Eigen::MatrixXd normal = gradient.transpose() * weight.asDiagonal() * gradient;
  normal.diagonal().array() += 1e-8 * normal.trace();  // an exponent that nothing tells has a wide interval, not none
  const Eigen::MatrixXd covariance = inverse(normal);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      relation.covariance[i][j] = covariance(i, j);
    }
  }
}

FittedRelation fit_relation(const Series& series, Relation kind, double scale, bool with_spread) {
  // Most of the likelihood lies between no spread and the scatter of the points: a grid, then a finer one.
  const double scatter = (series.y.array() - series.y.mean()).square().maxCoeff();
  double best_tau2 = 0.0;
  RelationFit best = fit_at(series, kind, 0.0, Search::Coarse);
  const auto visit = [&](double tau2) {
    const RelationFit fit = fit_at(series, kind, tau2, Search::Coarse);
    if (fit.deviance < best.deviance - 1e-9) {
      best = fit;
      best_tau2 = tau2;
    }
  };
  if (with_spread && scatter > 0.0) {
    for (int g = 0; g <= 8; ++g) {
      visit(scatter * std::pow(10.0, -4.0 + 0.5 * g));
    }
    for (double factor = std::pow(10.0, 0.25); best_tau2 > 0.0 && factor > 1.02; factor = std::sqrt(factor)) {
      const double centre = best_tau2;
      visit(centre * factor);
      visit(centre / factor);
    }
  }
  best = fit_at(series, kind, best_tau2, Search::Fine);
  const auto n = static_cast<double>(series.size());
  const auto shape_parameters = static_cast<double>(parameters_of(kind));
  const double k = shape_parameters;  // the spread is a nuisance of every relation alike
  FittedRelation relation;
  relation.relation = kind;
  relation.low = std::exp(best.shape.ln_low);
  relation.high = std::exp(best.shape.ln_high);
  relation.exponent = best.exponent;
  relation.scale = scale;
  relation.aicc = best.deviance + 2.0 * k + (n - k - 1.0 > 0.0 ? 2.0 * k * (k + 1.0) / (n - k - 1.0) : 0.0);
  // The likelihood's tau does not know of the parameters that were fitted: n/(n - p).
  const double tau2 = n > shape_parameters ? best_tau2 * n / (n - shape_parameters) : best_tau2;
  relation.spread = std::sqrt(tau2);
  if (with_spread) {
    relation.quantile = student_quantile(0.975, n - shape_parameters);
  }
  store_covariance(series, tau2, relation);
  return relation;
}

}  // namespace

std::string_view name_of(Relation relation) {
  switch (relation) {
    case Relation::Constant:
      return "constant";
    case Relation::Linear:
      return "linear";
    case Relation::Power:
      break;
  }
  return "power";
}

double FittedRelation::operator()(double at) const {
  return low + (high - low) * std::pow(std::fabs(at) / scale, exponent);
}

Result<Trend> fit_trend(std::vector<TrendPoint> points) {
  std::sort(points.begin(), points.end(), [](const TrendPoint& a, const TrendPoint& b) { return a.at < b.at; });
  if (points.size() < 2 || points.front().at == points.back().at) {
    return fail(ErrorCode::TooFewSamples, "A trend needs the parameter under at least two different conditions.");
  }
  for (const TrendPoint& point : points) {
    const Interval& ci = point.estimate.ci95;
    if (!(point.at >= 0.0) || !(point.estimate.value > 0.0) || !(ci.low > 0.0) || !(ci.high > ci.low) ||
        !std::isfinite(ci.high)) {
      return fail(ErrorCode::InvalidArgument, "A trend needs positive values with closed intervals.");
    }
  }
  Trend trend;
  trend.points = std::move(points);
  const Series series = series_of(trend.points);
  const auto n = static_cast<double>(series.size());
  trend.equal_statistic = regress(Eigen::MatrixXd::Ones(series.size(), 1), series.y, series.variance).chi_square;
  trend.equal_p = chi_squared_tail(trend.equal_statistic, n - 1.0);
  test_monotone(series, trend);
  const bool with_spread = series.size() >= 4;
  for (const Relation kind : {Relation::Constant, Relation::Linear, Relation::Power}) {
    const auto k = static_cast<double>(parameters_of(kind));
    if (with_spread ? n - k - 1.0 >= 1.0 : kind != Relation::Power) {
      trend.candidates.push_back(fit_relation(series, kind, trend.points.back().at, with_spread));
    }
  }
  trend.relation =
      with_spread ? *std::min_element(trend.candidates.begin(), trend.candidates.end(),
                                      [](const FittedRelation& a, const FittedRelation& b) { return a.aicc < b.aicc; })
                  : trend.candidates[trend.equal_p < kSize ? 1 : 0];
  return trend;
}

Interpolated value_at(const Trend& trend, double at) {
  const FittedRelation& relation = trend.relation;
  Interpolated result;
  const double size = std::fabs(at);
  const double inside = std::clamp(size, trend.points.front().at, trend.points.back().at);
  result.outside = inside != size;
  const double share = std::pow(inside / relation.scale, relation.exponent);
  const double value = relation(inside);
  std::array<double, 3> gradient{relation.low * (1.0 - share) / value, relation.high * share / value, 0.0};
  if (relation.relation == Relation::Constant) {
    gradient = {1.0, 0.0, 0.0};
  } else if (relation.relation == Relation::Power && share > 0.0) {
    gradient[2] =
        (relation.high - relation.low) * share * std::log(inside / relation.scale) * relation.exponent / value;
  }
  double variance = relation.spread * relation.spread;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      variance += gradient[i] * relation.covariance[i][j] * gradient[j];
    }
  }
  const double half_width = relation.quantile * std::sqrt(variance);
  result.estimate = {value, {value * std::exp(-half_width), value * std::exp(half_width)}};
  return result;
}

}  // namespace driftlab
