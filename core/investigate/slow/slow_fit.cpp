#include "core/investigate/slow/slow_fit.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// What the fit walks: the square of a level, or a shape.
double value_of(const SlowModel& model, const SlowParameter& parameter) {
  if (parameter.component == SlowParameter::kWhite) {
    return model.white;
  }
  const Process& process = model.components[parameter.component].process;
  return parameter.beta ? process.parameters[1] : process.square();
}

void set_value(SlowModel& model, const SlowParameter& parameter, double value) {
  if (parameter.component == SlowParameter::kWhite) {
    model.white = value;
    return;
  }
  std::vector<double>& values = model.components[parameter.component].process.parameters;
  values[parameter.beta ? 1 : 0] = parameter.beta ? value : std::sqrt(value);
}

std::vector<SlowParameter> free_parameters(const SlowModel& model, const SlowFreedom& freedom) {
  std::vector<SlowParameter> parameters;
  if (freedom.white) {
    parameters.push_back({});
  }
  for (std::size_t i = freedom.first_free; i < model.components.size(); ++i) {
    parameters.push_back({i, false});
    if (model.components[i].kind().has_shape()) {
      parameters.push_back({i, true});
    }
  }
  return parameters;
}

/// A Gauss-Markov process slower than 1.5 records is an offset, one faster than a block is white.
Interval bounds_of(const BlockSeries& series, const SlowModel& model, const SlowParameter& parameter) {
  const double white = model.white / series.block_s();
  const double long_s = series.longest_s();
  if (parameter.component == SlowParameter::kWhite) {
    return {0.0, std::numeric_limits<double>::infinity()};
  }
  if (parameter.beta) {
    return {1.5 / long_s, 1.5 / series.block_s()};
  }
  return {1e-7 * white * at_record_length(model.components[parameter.component].kind(), 1.0, long_s), 1e9 * white};
}

/// The likelihood of residuals e = y - X a under a model, and its whitened form.
struct Evaluation {
  Whitened whitened;
  double log_likelihood = 0.0;
};

Evaluation evaluate_residuals(const BlockSeries& series, const BlockColumns& residuals, const SlowModel& model) {
  Evaluation result;
  result.whitened = whiten(series, model, residuals);
  double square = 0.0;
  for (const auto& rows : result.whitened.columns.rows) {
    for (const double z : rows) {
      square += z * z;
    }
  }
  result.log_likelihood = -0.5 * (result.whitened.sum_log_var + square);
  return result;
}

BlockColumns residuals_of(const BlockColumns& columns, const Eigen::VectorXd& amplitude) {
  BlockColumns residuals;
  residuals.width = 1;
  for (const auto& rows : columns.rows) {
    std::vector<double> e(rows.size() / columns.width);
    for (std::size_t b = 0; b < e.size(); ++b) {
      e[b] = rows[b * columns.width];
      for (std::size_t c = 1; c < columns.width; ++c) {
        e[b] -= rows[b * columns.width + c] * amplitude[static_cast<Eigen::Index>(c - 1)];
      }
    }
    residuals.rows.push_back(std::move(e));
  }
  return residuals;
}

struct Derivatives {
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
};

/// Score and information by one-sided differences of innovations and variances in each logarithm.
Derivatives differentiate(const BlockSeries& series, const BlockColumns& residuals, const SlowModel& model,
                          const std::vector<SlowParameter>& parameters, const Whitened& here) {
  // Of a logarithm: the difference is wrong by 1e-4 of the slope's own change, and by 1e-12 from rounding.
  constexpr double kStep = 1e-4;
  const auto p = static_cast<Eigen::Index>(parameters.size());
  const auto n = static_cast<Eigen::Index>(here.log_var.size());
  Eigen::MatrixXd dv(n, p);  // dv / sqrt(S)
  Eigen::MatrixXd ds(n, p);  // dS / S
  Eigen::VectorXd z(n);
  Eigen::Index row = 0;
  for (const auto& rows : here.columns.rows) {
    for (const double value : rows) {
      z[row++] = value;
    }
  }
  for (Eigen::Index j = 0; j < p; ++j) {
    SlowModel moved = model;
    const SlowParameter& parameter = parameters[static_cast<std::size_t>(j)];
    set_value(moved, parameter, value_of(model, parameter) * std::exp(kStep));
    const Whitened there = whiten(series, moved, residuals);
    row = 0;
    for (const auto& rows : there.columns.rows) {
      for (const double value : rows) {
        // z = v/sqrt(S): dv/sqrt(S) = dz + z d(log S)/2
        const double dlog =
            (there.log_var[static_cast<std::size_t>(row)] - here.log_var[static_cast<std::size_t>(row)]) / kStep;
        ds(row, j) = dlog;
        dv(row, j) = (value - z[row]) / kStep + 0.5 * z[row] * dlog;
        ++row;
      }
    }
  }
  Derivatives result;
  result.information = dv.transpose() * dv + 0.5 * ds.transpose() * ds;
  result.score = -0.5 * (ds.transpose() * (Eigen::VectorXd::Ones(n) - z.cwiseAbs2()) + 2.0 * dv.transpose() * z);
  // Empty blocks carry z = 0 and dS = 0 and add nothing.
  return result;
}

}  // namespace

LeastSquares solve_whitened(const BlockColumns& whitened) {
  const auto width = static_cast<Eigen::Index>(whitened.width);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  for (std::size_t r = 0; r < whitened.rows.size(); ++r) {
    gram += gram_of(whitened, r);
  }
  LeastSquares result;
  const Eigen::Index p = width - 1;
  result.amplitude = Eigen::VectorXd::Zero(p);
  result.covariance = Eigen::MatrixXd::Zero(p, p);
  result.residual = gram(0, 0);
  if (p == 0) {
    return result;
  }
  // Scaled to unit diagonal; a regressor that vanishes gets amplitude 0 and an unbounded variance.
  Eigen::VectorXd scale = gram.diagonal().tail(p).cwiseSqrt();
  Eigen::MatrixXd normal = gram.bottomRightCorner(p, p);
  for (Eigen::Index i = 0; i < p; ++i) {
    if (!(scale[i] > 0.0)) {
      scale[i] = 1.0;
      normal(i, i) = 1.0;
    }
  }
  normal = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  normal.diagonal().array() += 1e-12;
  const Eigen::MatrixXd spread = solve_symmetric(normal, Eigen::MatrixXd(Eigen::MatrixXd::Identity(p, p)));
  const Eigen::VectorXd right = scale.cwiseInverse().cwiseProduct(gram.col(0).tail(p));
  const Eigen::VectorXd solution = spread * right;
  result.amplitude = scale.cwiseInverse().cwiseProduct(solution);
  result.covariance = scale.cwiseInverse().asDiagonal() * spread * scale.cwiseInverse().asDiagonal();
  result.residual = gram(0, 0) - right.dot(solution);
  return result;
}

SlowFit evaluate_slow(const BlockSeries& series, const BlockColumns& columns, const SlowModel& model) {
  const Whitened whitened = whiten(series, model, columns);
  const LeastSquares squares = solve_whitened(whitened.columns);
  SlowFit fit;
  fit.model = model;
  fit.amplitude = squares.amplitude;
  fit.amplitude_covariance = squares.covariance;
  fit.log_likelihood = -0.5 * (whitened.sum_log_var + squares.residual);
  fit.converged = true;
  return fit;
}

SlowFit fit_slow(const BlockSeries& series, const BlockColumns& columns, const SlowModel& start,
                 const SlowFreedom& freedom) {
  SlowFit fit = evaluate_slow(series, columns, start);
  fit.parameters = free_parameters(start, freedom);
  if (fit.parameters.empty()) {
    return fit;
  }
  fit.converged = false;
  double damping = 1e-3;
  for (int iteration = 0; iteration < freedom.iterations && !fit.converged && !freedom.stop.stop_requested();
       ++iteration) {
    const BlockColumns residuals = residuals_of(columns, fit.amplitude);
    const Evaluation here = evaluate_residuals(series, residuals, fit.model);
    const Derivatives d = differentiate(series, residuals, fit.model, fit.parameters, here.whitened);
    fit.information = d.information;
    bool moved = false;
    for (int attempt = 0; attempt < 6 && !moved; ++attempt) {
      Eigen::MatrixXd damped = d.information;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-9;
      const Eigen::VectorXd step = solve_symmetric(damped, d.score);
      if (0.5 * step.dot(d.score) < 5e-3) {
        fit.converged = true;
        break;
      }
      SlowModel trial = fit.model;
      for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
        const Interval bounds = bounds_of(series, fit.model, fit.parameters[j]);
        const double value = value_of(fit.model, fit.parameters[j]) *
                             std::exp(std::clamp(step[static_cast<Eigen::Index>(j)], -2.0, 2.0));
        set_value(trial, fit.parameters[j], std::clamp(value, bounds.low, bounds.high));
      }
      SlowFit next = evaluate_slow(series, columns, trial);
      if (next.log_likelihood > fit.log_likelihood) {
        const double gain = next.log_likelihood - fit.log_likelihood;
        next.parameters = std::move(fit.parameters);
        next.information = std::move(fit.information);
        fit = std::move(next);
        fit.converged = gain < 1e-2;
        damping = std::max(damping * 0.1, 1e-6);
        moved = true;
      } else {
        damping = std::max(damping * 10.0, 1e-2);
      }
    }
    if (!moved) {
      break;
    }
  }
  return fit;
}

Interval profile_amplitude(const BlockSeries& series, const BlockColumns& columns, const SlowFit& fit,
                           std::size_t column, const SlowFreedom& freedom) {
  const double centre = fit.amplitude[static_cast<Eigen::Index>(column - 1)];
  const double sd =
      std::sqrt(fit.amplitude_covariance(static_cast<Eigen::Index>(column - 1), static_cast<Eigen::Index>(column - 1)));
  if (free_parameters(fit.model, freedom).empty()) {
    return {centre - kNormal975 * sd, centre + kNormal975 * sd};
  }
  SlowModel warm = fit.model;
  SlowFreedom short_fit = freedom;
  short_fit.iterations = 4;
  // What rests at zero cannot be moved by its logarithm: it starts where it costs next to nothing.
  const double level = 0.003 * warm.white / series.block_s();
  for (std::size_t i = freedom.first_free; i < warm.components.size(); ++i) {
    SlowComponent& component = warm.components[i];
    raise_square(component, at_record_length(component.kind(), level, series.longest_s()));
  }
  const auto at = [&](double amplitude) {
    BlockColumns reduced;
    reduced.width = columns.width - 1;
    for (const auto& rows : columns.rows) {
      std::vector<double> out;
      out.reserve(rows.size());
      for (std::size_t b = 0; b < rows.size(); b += columns.width) {
        out.push_back(rows[b] - amplitude * rows[b + column]);
        for (std::size_t c = 1; c < columns.width; ++c) {
          if (c != column) {
            out.push_back(rows[b + c]);
          }
        }
      }
      reduced.rows.push_back(std::move(out));
    }
    return fit_slow(series, reduced, warm, short_fit).log_likelihood;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  return {profile_end(centre, -2.0 * sd, fit.log_likelihood, 3.8415, -infinity, at),
          profile_end(centre, 2.0 * sd, fit.log_likelihood, 3.8415, infinity, at)};
}

Interval profile_parameter(const BlockSeries& series, const BlockColumns& columns, const SlowFit& fit,
                           const SlowParameter& parameter, const SlowFreedom& freedom) {
  // The parameter is moved to the end of the list of free ones by fixing it: components are reordered so that the
  // fixed one comes before `first_free`, or its beta is held by a narrow search over the rest.
  const auto found = std::find(fit.parameters.begin(), fit.parameters.end(), parameter);
  if (found == fit.parameters.end() || fit.information.size() == 0) {
    const double value = value_of(fit.model, parameter);
    return {value, value};
  }
  const auto index = static_cast<Eigen::Index>(found - fit.parameters.begin());
  const Eigen::MatrixXd covariance =
      inverse(fit.information + 1e-9 * Eigen::MatrixXd::Identity(fit.information.rows(), fit.information.cols()));
  const double sd = std::sqrt(std::clamp(covariance(index, index), 1e-8, 4.0));
  const double centre = std::log(value_of(fit.model, parameter));
  const Interval bounds = bounds_of(series, fit.model, parameter);
  std::vector<SlowParameter> rest = fit.parameters;
  rest.erase(rest.begin() + index);
  const auto at = [&](double log_value) {
    SlowModel model = fit.model;
    set_value(model, parameter, std::exp(log_value));
    SlowFit there = evaluate_slow(series, columns, model);
    for (int iteration = 0; iteration < 4 && !rest.empty(); ++iteration) {
      const BlockColumns residuals = residuals_of(columns, there.amplitude);
      const Evaluation here = evaluate_residuals(series, residuals, there.model);
      const Derivatives d = differentiate(series, residuals, there.model, rest, here.whitened);
      Eigen::MatrixXd damped = d.information;
      damped.diagonal() *= 1.001;
      damped.diagonal().array() += 1e-9;
      const Eigen::VectorXd step = solve_symmetric(damped, d.score);
      SlowModel trial = there.model;
      for (std::size_t j = 0; j < rest.size(); ++j) {
        const Interval limits = bounds_of(series, fit.model, rest[j]);
        const double value =
            value_of(there.model, rest[j]) * std::exp(std::clamp(step[static_cast<Eigen::Index>(j)], -1.0, 1.0));
        set_value(trial, rest[j], std::clamp(value, limits.low, limits.high));
      }
      SlowFit next = evaluate_slow(series, columns, trial);
      if (next.log_likelihood < there.log_likelihood + 1e-3) {
        break;
      }
      there = std::move(next);
    }
    return there.log_likelihood;
  };
  const double low_limit = bounds.low > 0.0 ? std::log(bounds.low) : centre - 20.0;
  const double high_limit = std::isfinite(bounds.high) ? std::log(bounds.high) : centre + 20.0;
  (void)freedom;
  return {std::exp(profile_end(centre, -2.0 * sd, fit.log_likelihood, 3.8415, low_limit, at)),
          std::exp(profile_end(centre, 2.0 * sd, fit.log_likelihood, 3.8415, high_limit, at))};
}

}  // namespace driftlab::investigate
