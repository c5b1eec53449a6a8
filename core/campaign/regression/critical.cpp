#include "core/campaign/regression/critical.hpp"

#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr std::size_t kMostSessions = 30;
constexpr double kLongestFactor = 64.0;
constexpr std::size_t kDesignDraws = 1500;

/// L with L L' = a for a positive semidefinite a, with as many columns as a has rank: Cholesky with pivoting. `a` may
/// have a few directions only, as the device-wide scatter has.
Eigen::MatrixXd root_of(Eigen::MatrixXd a) {
  const Eigen::Index size = a.rows();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(size, size);
  const double tolerance = size > 0 ? 1e-12 * a.diagonal().maxCoeff() : 0.0;
  Eigen::Index rank = 0;
  for (; rank < size; ++rank) {
    Eigen::Index pivot = 0;
    const double largest = a.diagonal().maxCoeff(&pivot);
    if (!(largest > tolerance)) {
      break;
    }
    root.col(rank) = a.col(pivot) / std::sqrt(largest);
    a -= root.col(rank) * root.col(rank).transpose();
  }
  return root.leftCols(rank);
}

double student_factor(Random& random, std::size_t sessions, int df) {
  double sum = 0.0;
  for (std::size_t s = 0; s < sessions; ++s) {
    double chi_square = 0.0;
    for (int i = 0; i < df; ++i) {
      const double z = random.normal();
      chi_square += z * z;
    }
    sum += (df - 2.0) / chi_square;
  }
  return std::sqrt(sum / static_cast<double>(sessions));
}

/// The three parts of a draw over all tests, before the factors: columns are draws.
struct Parts {
  Eigen::MatrixXd sampling;
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;
};

Eigen::MatrixXd normal_draws(Random& random, Eigen::Index rows, std::size_t draws) {
  Eigen::MatrixXd z(rows, static_cast<Eigen::Index>(draws));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    z.data()[i] = random.normal();
  }
  return z;
}

Parts draw_parts(Random& random, const Contrast& contrast, std::size_t draws) {
  const auto part = [&](const Eigen::MatrixXd& covariance) -> Eigen::MatrixXd {
    const Eigen::MatrixXd root = contrast.combine * root_of(covariance);
    return root * normal_draws(random, root.cols(), draws);
  };
  Parts parts;
  parts.sampling = part(contrast.sampling);
  parts.common = part(contrast.common);
  parts.local = part(contrast.local);
  return parts;
}

/// The value below which a share `p` of the values lie.
double quantile_of(std::vector<double>& values, double p) {
  if (values.empty()) {
    return 0.0;
  }
  const auto place = static_cast<std::ptrdiff_t>(
      std::min(static_cast<double>(values.size() - 1), std::floor(p * static_cast<double>(values.size()))));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

double quantile_of_one(const Eigen::MatrixXd& draws, double p) {
  std::vector<double> all(draws.data(), draws.data() + draws.size());
  return quantile_of(all, p);
}

std::size_t compared_sessions(const Design& design) {
  return design.count(Arm::Baseline) + design.count(Arm::Candidate);
}

bool is_required(const Design& design, const Test& test, const TestSettings& settings) {
  return test.level ? design.units[test.unit].levels[*test.level].gated
                    : test.tau_s <= settings.through_s * (1.0 + 1e-9);
}

/// Share of the draws in which every gated test would pass.
double power_of(const Eigen::MatrixXd& draws, const Eigen::VectorXd& se, const std::vector<Test>& tests,
                const std::vector<bool>& gated, double c_1) {
  Eigen::Index passed = 0;
  for (Eigen::Index draw = 0; draw < draws.cols(); ++draw) {
    bool pass = true;
    for (Eigen::Index t = 0; pass && t < draws.rows(); ++t) {
      const auto test = static_cast<std::size_t>(t);
      pass = !gated[test] || (draws(t, draw) + c_1) * se(t) < tests[test].margin;
    }
    passed += pass ? 1 : 0;
  }
  return draws.cols() > 0 ? static_cast<double>(passed) / static_cast<double>(draws.cols()) : 0.0;
}

}  // namespace

Critical critical_values(const Design& design, const Contrast& contrast, const SessionScatter& scatter,
                         const TestSettings& settings) {
  Critical critical;
  if (contrast.tests.empty()) {
    return critical;
  }
  Random random(settings.seed);
  const Parts parts = draw_parts(random, contrast, settings.draws);
  critical.draws.resize(contrast.theta.size(), static_cast<Eigen::Index>(settings.draws));
  std::vector<double> cumulative;
  double sum = 0.0;
  for (std::size_t a = 0; a < kFactors; ++a) {
    for (std::size_t b = 0; b < kFactors; ++b) {
      sum += scatter.posterior(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      cumulative.push_back(sum);
    }
  }
  std::vector<double> largest;
  for (Eigen::Index draw = 0; draw < critical.draws.cols(); ++draw) {
    const auto place = std::lower_bound(cumulative.begin(), cumulative.end() - 1, random.uniform() * sum);
    const auto cell = static_cast<std::size_t>(place - cumulative.begin());
    const double h = student_factor(random, compared_sessions(design), settings.session_df);
    critical.draws.col(draw) = (parts.sampling.col(draw) + h * factor_grid()[cell / kFactors] * parts.common.col(draw) +
                                h * factor_grid()[cell % kFactors] * parts.local.col(draw))
                                   .cwiseQuotient(contrast.se);
    largest.push_back(critical.draws.col(draw).maxCoeff());
  }
  critical.c_max = quantile_of(largest, 1.0 - settings.look_share * (settings.alpha - settings.event_alpha));
  critical.c_1 = quantile_of_one(critical.draws, 1.0 - settings.look_share * settings.alpha);
  return critical;
}

Gate choose_gate(const Design& design, const Contrast& contrast, const Critical& critical,
                 const TestSettings& settings) {
  Gate gate;
  std::vector<double> longer;
  for (const Test& test : contrast.tests) {
    const bool required = is_required(design, test, settings);
    gate.gated.push_back(required);
    if (!test.level) {
      if (required) {
        gate.scope_s = std::max(gate.scope_s, test.tau_s);
      } else {
        longer.push_back(test.tau_s);
      }
    }
  }
  gate.power = power_of(critical.draws, contrast.se, contrast.tests, gate.gated, critical.c_1);
  std::sort(longer.begin(), longer.end());
  longer.erase(std::unique(longer.begin(), longer.end()), longer.end());
  for (const double tau_s : longer) {
    std::vector<bool> wider = gate.gated;
    for (std::size_t t = 0; t < contrast.tests.size(); ++t) {
      wider[t] = wider[t] || (!contrast.tests[t].level && contrast.tests[t].tau_s == tau_s);
    }
    const double power = power_of(critical.draws, contrast.se, contrast.tests, wider, critical.c_1);
    if (power < settings.design_power) {
      break;
    }
    gate = {std::move(wider), tau_s, power};
  }
  return gate;
}

Needs what_would_decide(const Design& design, const Contrast& contrast, const SessionScatter& scatter, const Gate& gate,
                        const TestSettings& settings, const std::stop_token& stop) {
  Needs needs;
  if (contrast.tests.empty()) {
    return needs;
  }
  Random random(settings.seed, 1);
  const Parts parts = draw_parts(random, contrast, kDesignDraws);
  const double kl = std::sqrt(scatter.mean_square_common());
  const double ks = std::sqrt(scatter.mean_square_local());
  const auto before_all = [&](const Eigen::MatrixXd& a) -> Eigen::VectorXd {
    return (contrast.combine * a * contrast.combine.transpose()).diagonal();
  };
  const Eigen::VectorXd sampling = before_all(contrast.sampling);
  const Eigen::VectorXd between = kl * kl * before_all(contrast.common) + ks * ks * before_all(contrast.local);
  /// Power with the two covariances so many times as large as they are now.
  const auto power = [&](double sampling_factor, double between_factor, std::size_t sessions) {
    const Eigen::VectorXd se = (sampling_factor * sampling + between_factor * between).cwiseSqrt();
    Random tails(settings.seed, 2);
    Eigen::MatrixXd draws(se.size(), static_cast<Eigen::Index>(kDesignDraws));
    for (Eigen::Index draw = 0; draw < draws.cols(); ++draw) {
      const double h = student_factor(tails, sessions, settings.session_df);
      draws.col(draw) = (std::sqrt(sampling_factor) * parts.sampling.col(draw) +
                         h * std::sqrt(between_factor) * (kl * parts.common.col(draw) + ks * parts.local.col(draw)))
                            .cwiseQuotient(se);
    }
    const double c_1 = quantile_of_one(draws, 1.0 - settings.look_share * settings.alpha);
    return power_of(draws, se, contrast.tests, gate.gated, c_1);
  };
  const auto n = static_cast<double>(design.count(Arm::Candidate));
  const auto m = static_cast<double>(design.count(Arm::Baseline));
  const double now = 1.0 / n + 1.0 / m;
  for (std::size_t sessions = 1; sessions <= kMostSessions && !needs.sessions_per_arm && !stop.stop_requested();
       ++sessions) {
    const double factor = 2.0 / static_cast<double>(sessions) / now;
    if (factor < 1.0 && power(factor, factor, 2 * sessions) >= settings.design_power) {
      needs.sessions_per_arm = sessions;
    }
  }
  for (double longer = 2.0; longer <= kLongestFactor && !needs.length_factor && !stop.stop_requested(); longer *= 2.0) {
    if (power(1.0 / longer, 1.0, compared_sessions(design)) >= settings.design_power) {
      needs.length_factor = longer;
    }
  }
  return needs;
}

}  // namespace driftlab::regression
