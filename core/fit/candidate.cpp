#include "core/fit/candidate.hpp"

#include "core/fit/j_test.hpp"
#include "core/fit/nested_start.hpp"
#include "core/process/dense.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace driftlab {
namespace {

/// A component whose whitened part of the curve is shorter than the root of this may be better left out.
constexpr double kFaint = 1e-2;
/// Relative difference of two values of L that are the same.
constexpr double kSame = 1e-9;

std::size_t count_parameters(const Model& active) {
  std::size_t count = 0;
  for (const Process& process : active) {
    count += process.parameters.size();
  }
  return count;
}

/// What `outer` holds beyond `inner`, which it contains.
std::vector<const ProcessKind*> missing_kinds(const ModelStructure& inner, const ModelStructure& outer) {
  std::vector<const ProcessKind*> missing;
  std::set_difference(outer.kinds.begin(), outer.kinds.end(), inner.kinds.begin(), inner.kinds.end(),
                      std::back_inserter(missing),
                      [](const ProcessKind* a, const ProcessKind* b) { return registry_index(a) < registry_index(b); });
  return missing;
}

/// The search for the least L of one structure.
class LeastDistance {
 public:
  LeastDistance(const WaveletMoments& moments, std::shared_ptr<const WhitenedCurve> curve)
      : moments_(moments), curve_(std::move(curve)) {}

  /// From a model with positive levels.
  void from(Model start) {
    if (!start.empty()) {
      keep(simplified(fitted(std::move(start))));
    }
  }

  /// From a smaller model's minimum, with the missing processes one after another. The smaller model as it is counts
  /// too: the missing ones vanish.
  void from_smaller(const LogFit& smaller, std::span<const ProcessKind* const> missing) {
    keep(fitted(smaller.model()));
    add(smaller, missing);
  }

  /// From a model with positive levels, with more processes one after another.
  void from_chain(Model first, std::span<const ProcessKind* const> missing) { add(*fitted(std::move(first)), missing); }

  /// The fit of least L; null where there was no start.
  [[nodiscard]] std::unique_ptr<LogFit> take() { return std::move(best_); }

 private:
  [[nodiscard]] std::unique_ptr<LogFit> fitted(Model start) const {
    sort_repeats(start);
    auto fit = std::make_unique<LogFit>(moments_, std::move(start), curve_);
    Model found = fit->model();
    const Model as_found = found;
    sort_repeats(found);
    const bool in_order = std::equal(found.begin(), found.end(), as_found.begin(),
                                     [](const Process& a, const Process& b) { return a.parameters == b.parameters; });
    if (!in_order) {
      fit = std::make_unique<LogFit>(moments_, std::move(found), curve_);
    }
    return fit;
  }

  void keep(std::unique_ptr<LogFit> fit) {
    if (best_ == nullptr || fit->minimum() < best_->minimum()) {
      best_ = std::move(fit);
    }
  }

  void add(const LogFit& smaller, std::span<const ProcessKind* const> missing) {
    if (missing.empty()) {
      return;
    }
    bool helps = false;
    for (Model& start : starts_with_more(moments_, smaller, *missing.front())) {
      std::unique_ptr<LogFit> fit = simplified(fitted(std::move(start)));
      if (!helps) {
        add(*fit, missing.subspan(1));
      }
      keep(std::move(fit));
      helps = true;
    }
    if (!helps) {
      add(smaller, missing.subspan(1));
    }
  }

  /// The fit, or where a component that hardly matters is better left out the fit without it.
  [[nodiscard]] std::unique_ptr<LogFit> simplified(std::unique_ptr<LogFit> fit) const {
    const Model model = fit->model();
    if (model.size() < 2) {
      return fit;
    }
    Eigen::MatrixXd jacobian;
    fit->evaluate(fit->best(), nullptr, &jacobian);
    for (std::size_t p = 0; p < model.size(); ++p) {
      if (jacobian.col(static_cast<Eigen::Index>(p)).squaredNorm() > kFaint) {
        continue;
      }
      Model without = model;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(p));
      std::unique_ptr<LogFit> smaller = fitted(std::move(without));
      if (smaller->minimum() <= fit->minimum() + kSame * std::max(1.0, fit->minimum())) {
        return simplified(std::move(smaller));
      }
    }
    return fit;
  }

  const WaveletMoments& moments_;
  std::shared_ptr<const WhitenedCurve> curve_;
  std::unique_ptr<LogFit> best_;
};

/// Starts from every known model that lacks as few processes as any; the other known models that are contained count as
/// they are. Where none is known, from the first process alone.
void search_from_smaller(const WaveletMoments& moments, const ModelStructure& structure,
                         std::span<const Candidate> known, LeastDistance& search) {
  std::size_t fewest = structure.kinds.size();
  const auto lacks = [&](const Candidate& candidate) {
    const bool contained =
        candidate.log_fit != nullptr && candidate.structure != structure && is_nested(candidate.structure, structure);
    return contained ? structure.kinds.size() - candidate.structure.kinds.size() : structure.kinds.size();
  };
  for (const Candidate& candidate : known) {
    fewest = std::min(fewest, lacks(candidate));
  }
  for (const Candidate& candidate : known) {
    if (const std::size_t count = lacks(candidate); count < structure.kinds.size()) {
      search.from_smaller(*candidate.log_fit, count == fewest ? missing_kinds(candidate.structure, structure)
                                                              : std::vector<const ProcessKind*>{});
    }
  }
  if (fewest == structure.kinds.size() && structure.kinds.size() > 1) {
    const GmwmSolution first =
        fit_gmwm(moments, {{structure.kinds.front()}}, MomentWeights::from_sd(moments.nu.cwiseMax(1e-300)));
    if (!first.active().empty()) {
      search.from_chain(first.active(), std::span(structure.kinds).subspan(1));
    }
  }
}

void complete(const WaveletMoments& moments, LeastDistance& search, std::span<const Candidate> known,
              Candidate& candidate) {
  search_from_smaller(moments, candidate.structure, known, search);
  candidate.log_fit = search.take();
  if (candidate.log_fit) {
    candidate.settle();
  }
}

}  // namespace

double Candidate::criterion(double samples) const {
  const bool forgiven = log_fit->curve().delta > 0.0;
  const double observations = forgiven ? static_cast<double>(log_fit->scales()) : samples;
  return ranked_distance() + static_cast<double>(structure.parameter_count()) * std::log(observations);
}

void Candidate::settle() {
  fit.model = log_fit->model();
  parameters = count_parameters(fit.model);
  fit.objective = log_fit->minimum();
  fit.converged = log_fit->converged();
  ModelStructure present;
  for (const Process& process : fit.model) {
    present.kinds.push_back(process.kind);
  }
  for (const ProcessKind* kind : missing_kinds(present, structure)) {
    fit.model.push_back({kind, std::vector<double>(kind->parameters.size(), 0.0)});
  }
  sort_repeats(fit.model);
}

Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure, const Eigen::VectorXd& sd,
                        const std::shared_ptr<const WhitenedCurve>& curve, std::span<const Candidate> known) {
  Candidate candidate;
  candidate.structure = structure;
  candidate.diagonal = fit_gmwm(moments, structure, MomentWeights::from_sd(sd));
  LeastDistance search(moments, curve);
  search.from(candidate.diagonal.active());
  complete(moments, search, known, candidate);
  candidate.test_distance = candidate.log_fit ? j_statistic(*candidate.log_fit) : 0.0;
  candidate.test_parameters = candidate.parameters;
  return candidate;
}

Candidate refit_candidate(const WaveletMoments& moments, const Candidate& before,
                          const std::shared_ptr<const WhitenedCurve>& curve, std::span<const Candidate> known) {
  Candidate candidate;
  candidate.structure = before.structure;
  candidate.diagonal = before.diagonal;
  candidate.test_distance = before.test_distance;
  candidate.test_parameters = before.test_parameters;
  candidate.eq8 = before.eq8;
  candidate.optimism = before.optimism;
  LeastDistance search(moments, curve);
  search.from(candidate.diagonal.active());
  if (before.log_fit) {
    search.from(before.log_fit->model());
  }
  complete(moments, search, known, candidate);
  return candidate;
}

double distance_under_own(const WaveletMoments& moments, const Candidate& candidate,
                          const CovarianceLaw& covariance_of) {
  const Model model = candidate.log_fit->model();
  const Eigen::VectorXd described = modelled_variance(moments, model);
  const auto own = std::make_shared<const WhitenedCurve>(
      whitened(curve_covariance(moments.nu, described, covariance_of(model)), 0.0));
  return LogFit(moments, model, own).minimum();
}

Equation8 equation_8(const WaveletMoments& moments, const GmwmSolution& solution, const Eigen::VectorXd& sd,
                     const Eigen::MatrixXd& covariance) {
  const Model active = solution.active();
  const Eigen::VectorXd weight = sd.cwiseInverse();
  const Eigen::VectorXd error = weight.cwiseProduct(moments.nu - modelled_variance(moments, active));
  Eigen::MatrixXd derivative(moments.nu.size(), static_cast<Eigen::Index>(count_parameters(active)));
  std::array<double, kMostParameters> gradient{};
  for (Eigen::Index j = 0; j < derivative.rows(); ++j) {
    Eigen::Index column = 0;
    for (const Process& process : active) {
      const auto row = static_cast<std::size_t>(j);
      process.haar_gradient(moments.half[row], moments.dt_at(row), gradient);
      for (std::size_t k = 0; k < process.parameters.size(); ++k) {
        derivative(j, column++) = gradient[k] * weight(j);
      }
    }
  }
  for (Eigen::Index k = 0; k < derivative.cols(); ++k) {
    const double length = derivative.col(k).norm();
    derivative.col(k) /= length > 0.0 ? length : 1.0;
  }
  // tr(W C W D (D'WD)^-1 D') = tr(H S): H the projector on the weighted derivatives, S the weighted covariance.
  const Eigen::MatrixXd scaled = weight.asDiagonal() * covariance * weight.asDiagonal();
  const Eigen::MatrixXd projected = derivative * least_squares(derivative, scaled);
  return {error.squaredNorm(), 2.0 * std::max(0.0, projected.trace())};
}

}  // namespace driftlab
