#include "core/campaign/regression/session_scatter.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kLowest = 0.25;
constexpr double kHighest = 6.0;

using Grid = Eigen::Matrix<double, kFactors, kFactors>;

/// Contrasts with one sampling covariance: their vectors side by side.
struct ContrastGroup {
  Eigen::MatrixXd sampling;  ///< sum_r h_r^2 S_r/4 over the common rows
  std::vector<Eigen::Index> rows;
  Eigen::MatrixXd values;  ///< rows x contrasts
};

/// Sessions of one arm or release of one device.
std::vector<std::vector<const Session*>> arms_of(const Design& design) {
  std::map<std::tuple<Arm, std::size_t, std::size_t>, std::vector<const Session*>> arms;
  for (const Session& session : design.sessions) {
    arms[{session.arm, session.arm == Arm::History ? session.release : 0, session.group}].push_back(&session);
  }
  std::vector<std::vector<const Session*>> list;
  for (auto& [key, sessions] : arms) {
    list.push_back(std::move(sessions));
  }
  return list;
}

void add_sampling(const Design& design, const Session& session, double factor, Eigen::MatrixXd& sum) {
  for (std::size_t u = 0; u < design.units.size(); ++u) {
    const auto first = static_cast<Eigen::Index>(design.units[u].first);
    const auto count = static_cast<Eigen::Index>(design.units[u].count);
    sum.block(first, first, count, count) += factor * (*session.sampling)[u];
  }
}

Eigen::MatrixXd restricted(const Eigen::MatrixXd& whole, const std::vector<Eigen::Index>& rows) {
  return whole(rows, rows);
}

/// The contrasts of one arm. Where its sessions are equally long they share one covariance.
void add_contrasts(const Design& design, const std::vector<const Session*>& sessions,
                   std::vector<ContrastGroup>& groups) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index row = 0; row < design.size(); ++row) {
    if (std::all_of(sessions.begin(), sessions.end(),
                    [&](const Session* session) { return session->has[static_cast<std::size_t>(row)]; })) {
      rows.push_back(row);
    }
  }
  if (sessions.size() < 2 || rows.empty()) {
    return;
  }
  const bool alike = std::all_of(sessions.begin(), sessions.end(), [&](const Session* session) {
    return session->sampling == sessions.front()->sampling;
  });
  const std::size_t first_group = groups.size();
  Eigen::VectorXd sum = sessions.front()->x;
  for (std::size_t r = 1; r < sessions.size(); ++r) {  // h = (1, ..., 1, -r)/sqrt(r (r + 1))
    const auto count = static_cast<double>(r);
    const double norm = 1.0 / std::sqrt(count * (count + 1.0));
    const Eigen::VectorXd contrast = norm * (sum - count * sessions[r]->x);
    sum += sessions[r]->x;
    if (!alike || r == 1) {
      Eigen::MatrixXd sampling = Eigen::MatrixXd::Zero(design.size(), design.size());
      for (std::size_t s = 0; s < r; ++s) {
        add_sampling(design, *sessions[s], norm * norm, sampling);
      }
      add_sampling(design, *sessions[r], norm * norm * count * count, sampling);
      groups.push_back({restricted(sampling, rows), rows, Eigen::MatrixXd(static_cast<Eigen::Index>(rows.size()), 0)});
    }
    ContrastGroup& group = alike ? groups[first_group] : groups.back();
    group.values.conservativeResize(Eigen::NoChange, group.values.cols() + 1);
    group.values.col(group.values.cols() - 1) = contrast(rows);
  }
}

double log_likelihood(const ContrastGroup& group, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::MatrixXd whitened = factor.matrixL().solve(group.values);
  const double log_root = factor.matrixLLT().diagonal().array().log().sum();
  return -0.5 * whitened.squaredNorm() - log_root * static_cast<double>(group.values.cols());
}

double quantile(const Eigen::Matrix<double, kFactors, 1>& marginal, double p) {
  double below = 0.0;
  for (std::size_t i = 0; i < kFactors; ++i) {
    below += marginal(static_cast<Eigen::Index>(i));
    if (below >= p) {
      return factor_grid()[i];
    }
  }
  return factor_grid().back();
}

double mean_square(const Eigen::Matrix<double, kFactors, 1>& marginal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kFactors; ++i) {
    sum += marginal(static_cast<Eigen::Index>(i)) * factor_grid()[i] * factor_grid()[i];
  }
  return sum;
}

}  // namespace

const std::array<double, kFactors>& factor_grid() {
  static const std::array<double, kFactors> grid = [] {
    std::array<double, kFactors> points{};
    for (std::size_t i = 0; i < kFactors; ++i) {
      points[i] = kLowest * std::pow(kHighest / kLowest, static_cast<double>(i) / (kFactors - 1));
    }
    return points;
  }();
  return grid;
}

ScatterTerms scatter_terms(const Design& design) {
  ScatterTerms terms{Eigen::MatrixXd::Zero(design.size(), design.size()),
                     Eigen::MatrixXd::Zero(design.size(), design.size())};
  for (Eigen::Index i = 0; i < design.size(); ++i) {
    const Row& a = design.rows[static_cast<std::size_t>(i)];
    const Tau0& own = design.units[a.unit].tau0;
    for (Eigen::Index j = 0; j < design.size(); ++j) {
      const Row& b = design.rows[static_cast<std::size_t>(j)];
      terms.common(i, j) = own.device * design.units[b.unit].tau0.device;
      if (a.unit == b.unit) {
        terms.common(i, j) += own.axis * own.axis;
        terms.local(i, j) = own.scale * own.scale * std::exp(-std::abs(a.octave - b.octave) / kOctavesOfCorrelation);
      }
    }
  }
  return terms;
}

double SessionScatter::mean_square_common() const { return mean_square(posterior.rowwise().sum()); }
double SessionScatter::mean_square_local() const { return mean_square(posterior.colwise().sum().transpose()); }
double SessionScatter::quantile_common(double p) const { return quantile(posterior.rowwise().sum(), p); }
double SessionScatter::quantile_local(double p) const { return quantile(posterior.colwise().sum().transpose(), p); }

SessionScatter learn_scatter(const Design& design, const ScatterTerms& terms, double prior_df,
                             const std::stop_token& stop) {
  SessionScatter scatter;
  Grid log_density;
  for (std::size_t a = 0; a < kFactors; ++a) {
    for (std::size_t b = 0; b < kFactors; ++b) {
      const auto log_prior = [&](double k) { return -prior_df * std::log(k) - prior_df / (2.0 * k * k); };
      log_density(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          log_prior(factor_grid()[a]) + log_prior(factor_grid()[b]);
    }
  }
  std::vector<ContrastGroup> groups;
  for (const std::vector<const Session*>& sessions : arms_of(design)) {
    add_contrasts(design, sessions, groups);
  }
  for (const ContrastGroup& group : groups) {
    scatter.contrasts += static_cast<std::size_t>(group.values.cols());
    const Eigen::MatrixXd common = restricted(terms.common, group.rows);
    const Eigen::MatrixXd local = restricted(terms.local, group.rows);
    for (std::size_t a = 0; a < kFactors && !stop.stop_requested(); ++a) {
      for (std::size_t b = 0; b < kFactors && !stop.stop_requested(); ++b) {
        const double kl = factor_grid()[a];
        const double ks = factor_grid()[b];
        log_density(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) +=
            log_likelihood(group, group.sampling + kl * kl * common + ks * ks * local);
      }
    }
  }
  scatter.posterior = (log_density.array() - log_density.maxCoeff()).exp();
  scatter.posterior /= scatter.posterior.sum();
  return scatter;
}

}  // namespace driftlab::regression
