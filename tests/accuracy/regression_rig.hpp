#pragma once
/// Simulated regression runs: six axes whose sessions scatter by the law that the comparison assumes, with a scale of
/// the rig's own, ln k ~ N(0, 0.5), and Student's t5 over the sessions (spec/regression.md, section 10).
#include "core/campaign/regression/release_trend.hpp"
#include "core/campaign/regression/verdict.hpp"
#include "core/process/distributions.hpp"
#include "core/process/model.hpp"
#include "core/variance/haar_covariance.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

namespace driftlab::accuracy {

/// How the sessions of simulated rigs scatter. The defaults are the form that the comparison assumes.
struct Scatter {
  double factor_sd = 0.5;   ///< of ln kL and ln kS between rigs
  double octaves = 1.5;     ///< over which what a session adds to a scale is alike
  bool one_factor = false;  ///< kL = kS: a rig is restless in all or in nothing
};

/// What all axes of a simulated device are made of.
enum class Made { WhiteFlickerWalk, WhiteWalk };

/// A device of six axes with white noise, flicker and a little random walk, 100 Hz; or without the flicker.
class Rig {
 public:
  static constexpr double kDt = 0.01;
  static constexpr std::size_t kAxes = 6;

  explicit Rig(double duration_s, Scatter scatter = {}, Made made = Made::WhiteFlickerWalk)
      : factor_sd_(scatter.factor_sd), one_factor_(scatter.one_factor) {
    model_ = {*make_process("white_noise", {1.0}), *make_process("random_walk", {0.02})};
    std::vector<regression::Level> levels{{"white_noise", "N", 0.0, true}, {"random_walk", "K", std::log(1.5), false}};
    if (made == Made::WhiteFlickerWalk) {
      model_.insert(model_.begin() + 1, *make_process("flicker_noise", {0.8}));
      levels.insert(levels.begin() + 1, {"flicker_noise", "B", std::log(1.25), false});
    }
    const auto samples = static_cast<std::size_t>(duration_s / kDt);
    std::vector<std::size_t> half;
    for (std::size_t m = 1; 2 * m <= samples; m *= 2) {
      half.push_back(m);
    }
    covariance_ = relative_covariance(half, samples);
    std::size_t scales = 0;
    while (scales < half.size() &&
           2.0 / covariance_(static_cast<Eigen::Index>(scales), static_cast<Eigen::Index>(scales)) >= 10.0) {
      ++scales;
    }
    const auto rows = static_cast<Eigen::Index>(scales);
    const Eigen::MatrixXd sampling = 0.25 * covariance_.topLeftCorner(rows, rows);
    root_ = Eigen::LLT<Eigen::MatrixXd>(sampling).matrixL();
    sampling_ = std::make_shared<regression::Sampling>(kAxes, sampling);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const bool gyroscope = axis < 3;
      regression::Unit unit;
      unit.tau0 = gyroscope ? regression::Tau0{0.010, 0.012, 0.012} : regression::Tau0{0.015, 0.025, 0.025};
      unit.first = axis * scales;
      unit.count = scales;
      unit.levels = levels;
      unit.levels.front().margin = std::log(gyroscope ? 1.1 : 1.2);
      unit.modelled.resize(rows);
      unit.sensitivity.resize(rows, static_cast<Eigen::Index>(model_.size()));
      for (std::size_t j = 0; j < scales; ++j) {
        const auto m = static_cast<double>(half[j]);
        const double tau = m * kDt;
        const double total = haar_variance(model_, m, kDt);
        unit.modelled(static_cast<Eigen::Index>(j)) = 0.5 * std::log(total);
        for (std::size_t p = 0; p < model_.size(); ++p) {
          unit.sensitivity(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(p)) =
              model_[p].haar_variance(m, kDt) / total;
        }
        const double percent = tau <= 1.0 ? (gyroscope ? 10.0 : 20.0) : tau <= 10.0 ? 25.0 : 50.0;
        design_.rows.push_back({axis, static_cast<int>(j), tau, std::log(1.0 + percent / 100.0)});
      }
      design_.units.push_back(std::move(unit));
    }
    common_ = root(regression::scatter_terms(design_).common);
    local_ = root(local_scatter(scatter.octaves));
  }

  /// By how much a rig is more restless than the prior: what all scales share, and what each has of its own.
  struct Factors {
    double common = 1.0;
    double local = 1.0;
  };
  [[nodiscard]] Factors draw_factors(Random& random) const {
    const double common = std::exp(factor_sd_ * random.normal());
    return {common, one_factor_ ? common : std::exp(factor_sd_ * random.normal())};
  }

  /// What is added to the candidate's rows.
  using Change = std::function<double(const regression::Row&)>;

  [[nodiscard]] const regression::Design& rows() const { return design_; }
  /// 1/2 ln nu of the axis at half length m.
  [[nodiscard]] double variance(double m) const { return haar_variance(model_, m, kDt); }
  [[nodiscard]] double white(double m) const { return model_[0].haar_variance(m, kDt); }

  /// One rig and its sessions. `scale`: the rig is so many times as restless as the prior; 0: drawn.
  [[nodiscard]] regression::Design draw(Random& random, std::size_t baseline, std::size_t candidate,
                                        std::size_t history, const Change& change, double scale = 0.0) const {
    regression::Design design = design_;
    const Factors factors = scale > 0.0 ? Factors{scale, scale} : draw_factors(random);
    const auto add = [&](regression::Arm arm, std::size_t count) {
      for (std::size_t r = 0; r < count; ++r) {
        design.sessions.push_back(session(random, arm, factors));
        for (Eigen::Index row = 0; arm == regression::Arm::Candidate && row < design.size(); ++row) {
          design.sessions.back().x(row) += change(design.rows[static_cast<std::size_t>(row)]);
        }
      }
    };
    add(regression::Arm::Baseline, baseline);
    add(regression::Arm::Candidate, candidate);
    add(regression::Arm::History, history);
    return design;
  }

  [[nodiscard]] regression::Session session(Random& random, regression::Arm arm, const Factors& factors) const {
    regression::Session session;
    session.arm = arm;
    session.has.assign(design_.rows.size(), true);
    session.sampling = sampling_;
    session.x.resize(design_.size());
    const auto normals = [&random](Eigen::Index count) {
      Eigen::VectorXd z(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        z(i) = random.normal();
      }
      return z;
    };
    for (const regression::Unit& unit : design_.units) {
      const auto count = static_cast<Eigen::Index>(unit.count);
      session.x.segment(static_cast<Eigen::Index>(unit.first), count) = unit.modelled + root_ * normals(count);
    }
    double chi_square = 0.0;
    for (int i = 0; i < 5; ++i) {
      const double z = random.normal();
      chi_square += z * z;
    }
    const double student = std::sqrt(3.0 / chi_square);
    session.x += student * (factors.common * (common_ * normals(design_.size())) +
                            factors.local * (local_ * normals(design_.size())));
    return session;
  }

 private:
  static Eigen::MatrixXd root(const Eigen::MatrixXd& a) {
    const Eigen::MatrixXd raised = a + 1e-12 * a.trace() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
    return Eigen::LLT<Eigen::MatrixXd>(raised).matrixL();
  }

  /// What a session adds to the scales of each axis, correlated over so many octaves.
  [[nodiscard]] Eigen::MatrixXd local_scatter(double octaves) const {
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(design_.size(), design_.size());
    for (const regression::Unit& unit : design_.units) {
      for (std::size_t j = 0; j < unit.count; ++j) {
        for (std::size_t other = 0; other < unit.count; ++other) {
          const double apart = std::abs(static_cast<double>(j) - static_cast<double>(other));
          local(static_cast<Eigen::Index>(unit.first + j), static_cast<Eigen::Index>(unit.first + other)) =
              unit.tau0.scale * unit.tau0.scale * std::exp(-apart / octaves);
        }
      }
    }
    return local;
  }

  [[nodiscard]] Eigen::MatrixXd relative_covariance(const std::vector<std::size_t>& half, std::size_t samples) const {
    HaarCovariance plan(half, samples, kDt);
    Eigen::MatrixXd covariance = plan.matrix(model_);
    Eigen::VectorXd nu(covariance.rows());
    for (Eigen::Index j = 0; j < nu.size(); ++j) {
      nu(j) = haar_variance(model_, static_cast<double>(half[static_cast<std::size_t>(j)]), kDt);
    }
    covariance = nu.cwiseInverse().asDiagonal() * covariance * nu.cwiseInverse().asDiagonal();
    for (Eigen::Index j = 0; j < nu.size(); ++j) {
      covariance(j, j) = trigamma(1.0 / covariance(j, j));
    }
    return covariance;
  }

  double factor_sd_;
  bool one_factor_;
  Model model_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd root_;
  std::shared_ptr<const regression::Sampling> sampling_;
  regression::Design design_;
  Eigen::MatrixXd common_;
  Eigen::MatrixXd local_;
};

/// The first so many sessions of each of the two arms.
inline regression::Design first_sessions(const regression::Design& all, std::size_t per_arm) {
  regression::Design design = all;
  design.sessions.clear();
  for (const regression::Session& session : all.sessions) {
    if (design.count(session.arm) < per_arm) {
      design.sessions.push_back(session);
    }
  }
  return design;
}

/// A baseline of long sessions against a candidate of short ones of the same device, which lack the longest scales.
inline regression::Design draw_unequal(const Rig& longer, const Rig& shorter, Random& random, std::size_t sessions,
                                       const Rig::Change& change) {
  regression::Design design = longer.rows();
  const Rig::Factors factors = longer.draw_factors(random);
  for (std::size_t r = 0; r < sessions; ++r) {
    design.sessions.push_back(longer.session(random, regression::Arm::Baseline, factors));
  }
  auto sampling = std::make_shared<regression::Sampling>();
  for (std::size_t r = 0; r < sessions; ++r) {
    const regression::Session drawn = shorter.session(random, regression::Arm::Candidate, factors);
    regression::Session widened = drawn;
    widened.has.assign(design.rows.size(), false);
    widened.x = Eigen::VectorXd::Zero(design.size());
    for (std::size_t u = 0; u < design.units.size(); ++u) {
      const regression::Unit& unit = design.units[u];
      const regression::Unit& own = shorter.rows().units[u];
      if (r == 0) {  // rows that the session lacks have no weight: any variance will do
        const auto count = static_cast<Eigen::Index>(unit.count);
        const auto known = static_cast<Eigen::Index>(own.count);
        sampling->push_back(Eigen::MatrixXd::Identity(count, count));
        sampling->back().topLeftCorner(known, known) = (*drawn.sampling)[u];
      }
      for (std::size_t j = 0; j < own.count; ++j) {
        const auto row = static_cast<Eigen::Index>(unit.first + j);
        widened.has[unit.first + j] = true;
        widened.x(row) = drawn.x(static_cast<Eigen::Index>(own.first + j)) + change(design.rows[unit.first + j]);
      }
    }
    widened.sampling = sampling;
    design.sessions.push_back(std::move(widened));
  }
  return design;
}

/// Releases of one device, each of some sessions; the anchor is the first, the candidate the last.
struct Releases {
  regression::Design design;
  regression::ReleaseOrder order;
};

/// What is added to the rows of a release, counted from 0.
using ReleaseChange = std::function<double(const regression::Row&, double)>;

inline Releases draw_releases(const Rig& rig, Random& random, std::size_t releases, std::size_t sessions,
                              const ReleaseChange& change) {
  const auto last = static_cast<double>(releases - 1);
  Releases drawn{
      rig.draw(random, sessions, sessions, (releases - 2) * sessions, [](const regression::Row&) { return 0.0; }),
      {{}, 0.0, last}};
  for (regression::Unit& unit : drawn.design.units) {  // what is fitted to the pooled curve of baseline and candidate
    for (std::size_t j = 0; j < unit.count; ++j) {
      const regression::Row& row = drawn.design.rows[unit.first + j];
      unit.modelled(static_cast<Eigen::Index>(j)) += 0.5 * (change(row, 0.0) + change(row, last));
    }
  }
  std::size_t earlier = 0;
  for (regression::Session& session : drawn.design.sessions) {
    double at = session.arm == regression::Arm::Baseline ? 0.0 : last;
    if (session.arm == regression::Arm::History) {
      session.release = earlier++ / sessions;
      at = static_cast<double>(session.release) + 1.0;
    }
    drawn.order.position.push_back(at);
    for (Eigen::Index row = 0; row < drawn.design.size(); ++row) {
      session.x(row) += change(drawn.design.rows[static_cast<std::size_t>(row)], at);
    }
  }
  return drawn;
}

/// Whether a test is found beyond its margin that is not. The change of a level is what the comparison makes of the
/// changes of its scales: where each scale is at its own margin, a level whose scales have wider margins is beyond its.
inline bool blames_wrongly(const regression::Comparison& comparison, const std::vector<regression::Row>& rows,
                           const Rig::Change& change) {
  const regression::Contrast& contrast = comparison.contrast;
  Eigen::VectorXd scales(contrast.combine.cols());
  for (Eigen::Index t = 0; t < scales.size(); ++t) {
    scales(t) = change(rows[static_cast<std::size_t>(contrast.tests[static_cast<std::size_t>(t)].row)]);
  }
  const Eigen::VectorXd truth = contrast.combine * scales;
  for (std::size_t t = 0; t < contrast.tests.size(); ++t) {
    if (comparison.outcomes[t].finding == regression::Finding::Beyond &&
        truth(static_cast<Eigen::Index>(t)) <= contrast.tests[t].margin + 1e-9) {
      return true;
    }
  }
  return false;
}

/// Shares of verdicts.
struct Shares {
  std::size_t runs = 0;
  std::size_t pass = 0;
  std::size_t fail = 0;
  std::size_t wrong_fail = 0;  ///< of the fails, those that blame what is within its margin
  std::vector<double> scope_s;

  void add(const regression::Comparison& comparison, bool wrongly = false) {
    ++runs;
    wrong_fail += wrongly ? 1U : 0U;
    pass += comparison.verdict == regression::Verdict::Pass ? 1U : 0U;
    fail += comparison.verdict == regression::Verdict::Fail ? 1U : 0U;
    scope_s.push_back(comparison.gate.scope_s);
  }
  [[nodiscard]] double percent(std::size_t count) const {
    return 100.0 * static_cast<double>(count) / static_cast<double>(runs);
  }
  [[nodiscard]] std::size_t inconclusive() const { return runs - pass - fail; }
  [[nodiscard]] double median_scope() const {
    std::vector<double> sorted = scope_s;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

struct Sessions {
  std::size_t baseline = 3;
  std::size_t candidate = 3;
  std::size_t history = 0;
};

/// All alpha in the noise family, one look: as the table of the specification.
inline regression::TestSettings table_settings() {
  regression::TestSettings settings;
  settings.look_share = 1.0;
  settings.event_alpha = 0.0;
  return settings;
}

inline Shares run_many(const Rig& rig, const Sessions& sessions, const Rig::Change& change, std::size_t runs,
                       std::uint64_t seed, const regression::TestSettings& settings = table_settings(),
                       double scale = 0.0) {
  Shares shares;
  for (std::size_t run = 0; run < runs; ++run) {
    Random random(seed, run);
    const regression::Comparison comparison = regression::compare(
        rig.draw(random, sessions.baseline, sessions.candidate, sessions.history, change, scale), settings);
    shares.add(comparison, blames_wrongly(comparison, rig.rows().rows, change));
  }
  return shares;
}

}  // namespace driftlab::accuracy
