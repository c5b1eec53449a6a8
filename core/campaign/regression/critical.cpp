#include "core/campaign/regression/critical.hpp"

#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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

/// Square of the factor by which a session scatters more or less than others do.
double session_square(Random& random, int df) {
  double chi_square = 0.0;
  for (int i = 0; i < df; ++i) {
    const double z = random.normal();
    chi_square += z * z;
  }
  return (df - 2.0) / chi_square;
}

/// h of a difference between two arms with so many sessions in all, equally many in each.
double student_factor(Random& random, std::size_t sessions, int df) {
  double sum = 0.0;
  for (std::size_t s = 0; s < sessions; ++s) {
    sum += session_square(random, df);
  }
  return std::sqrt(sum / static_cast<double>(sessions));
}

/// h per test of a scale.
Eigen::VectorXd student_factors(Random& random, const Eigen::MatrixXd& shares, int df) {
  Eigen::VectorXd squares(shares.cols());
  for (double& square : squares) {
    square = session_square(random, df);
  }
  return (shares * squares).cwiseSqrt();
}

/// The three parts of a draw over the tests of scales, before the factors: columns are draws.
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
    const Eigen::MatrixXd root = root_of(covariance);
    return root * normal_draws(random, root.cols(), draws);
  };
  Parts parts;
  parts.sampling = part(contrast.sampling);
  parts.common = part(contrast.common);
  parts.local = part(contrast.local);
  return parts;
}

/// Draws over all tests, levels made of their scales, in units of `se`.
Eigen::MatrixXd over_all_tests(const Contrast& contrast, const Eigen::MatrixXd& scales, const Eigen::VectorXd& se) {
  const Eigen::Index levels = contrast.combine.rows() - scales.rows();
  Eigen::MatrixXd draws(contrast.combine.rows(), scales.cols());
  draws.topRows(scales.rows()) = scales;
  draws.bottomRows(levels).noalias() = contrast.combine.bottomRows(levels) * scales;
  return se.cwiseInverse().asDiagonal() * draws;
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

Critical critical_values(const Contrast& contrast, const SessionScatter& scatter, const TestSettings& settings) {
  Critical critical;
  if (contrast.tests.empty()) {
    return critical;
  }
  Random random(settings.seed);
  const Parts parts = draw_parts(random, contrast, settings.draws);
  Eigen::MatrixXd scales(parts.sampling.rows(), parts.sampling.cols());
  std::vector<double> cumulative;
  double sum = 0.0;
  for (std::size_t a = 0; a < kFactors; ++a) {
    for (std::size_t b = 0; b < kFactors; ++b) {
      sum += scatter.posterior(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      cumulative.push_back(sum);
    }
  }
  for (Eigen::Index draw = 0; draw < scales.cols(); ++draw) {
    const auto place = std::lower_bound(cumulative.begin(), cumulative.end() - 1, random.uniform() * sum);
    const auto cell = static_cast<std::size_t>(place - cumulative.begin());
    const Eigen::VectorXd h = student_factors(random, contrast.shares, settings.session_df);
    scales.col(draw) =
        parts.sampling.col(draw) + h.cwiseProduct(factor_grid()[cell / kFactors] * parts.common.col(draw) +
                                                  factor_grid()[cell % kFactors] * parts.local.col(draw));
  }
  critical.draws = over_all_tests(contrast, scales, contrast.se);
  std::vector<double> largest(static_cast<std::size_t>(critical.draws.cols()));
  Eigen::VectorXd::Map(largest.data(), critical.draws.cols()) = critical.draws.colwise().maxCoeff();
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
  const Eigen::MatrixXd between_parts = kl * parts.common + ks * parts.local;
  using Tails = std::function<Eigen::VectorXd(Random&)>;
  /// Power with the two covariances so many times as large as they are now.
  const auto power = [&](double sampling_factor, double between_factor, const Tails& tails) {
    const Eigen::VectorXd se = (sampling_factor * sampling + between_factor * between).cwiseSqrt();
    Random random_tails(settings.seed, 2);
    Eigen::MatrixXd scales = std::sqrt(sampling_factor) * parts.sampling;
    for (Eigen::Index draw = 0; draw < scales.cols(); ++draw) {
      scales.col(draw) += std::sqrt(between_factor) * tails(random_tails).cwiseProduct(between_parts.col(draw));
    }
    const Eigen::MatrixXd draws = over_all_tests(contrast, scales, se);
    const double c_1 = quantile_of_one(draws, 1.0 - settings.look_share * settings.alpha);
    return power_of(draws, se, contrast.tests, gate.gated, c_1);
  };
  const Tails as_now = [&](Random& drawn) { return student_factors(drawn, contrast.shares, settings.session_df); };
  const auto n = static_cast<double>(design.count(Arm::Candidate));
  const auto m = static_cast<double>(design.count(Arm::Baseline));
  const double now = 1.0 / n + 1.0 / m;
  for (std::size_t sessions = 1; sessions <= kMostSessions && !needs.sessions_per_arm && !stop.stop_requested();
       ++sessions) {
    const double factor = 2.0 / static_cast<double>(sessions) / now;
    const Tails equal_arms = [&](Random& drawn) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(between_parts.rows(), student_factor(drawn, 2 * sessions, settings.session_df));
    };
    if (factor < 1.0 && power(factor, factor, equal_arms) >= settings.design_power) {
      needs.sessions_per_arm = sessions;
    }
  }
  for (double longer = 2.0; longer <= kLongestFactor && !needs.length_factor && !stop.stop_requested(); longer *= 2.0) {
    if (power(1.0 / longer, 1.0, as_now) >= settings.design_power) {
      needs.length_factor = longer;
    }
  }
  return needs;
}

}  // namespace driftlab::regression
