#include "core/fit/ieee952_coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace driftlab {
namespace {

using Of = CompositeQuantity::Of;

constexpr double kRise95 = 3.841458820694124;
/// Of an upper limit: one side.
constexpr double kRise95OneSided = 2.705543454095404;
/// Relative standard error of a squared level above which the curvature is not trusted and the profile is taken.
constexpr double kCurvatureHolds = 0.01;
constexpr double kMostDiscrepancy = 0.05;
/// A coefficient is there if it is in every model whose cost is this close to the best: less than a parameter costs, or
/// any larger model would speak against it.
constexpr double kAsGood = 3.0;

/// A coefficient: its term, and the place of its results.
struct Term {
  std::string_view kind;
  std::string_view symbol;
  std::string_view title;
  std::optional<Estimate> AllanParameters::* estimate;
  std::string AllanParameters::* reason;
  double AllanParameters::* limit;
};

constexpr Term kTerms[] = {
    {"quantization_noise", "Q", "quantization noise", &AllanParameters::q, &AllanParameters::q_reason,
     &AllanParameters::q_limit},
    {"white_noise", "N", "white noise", &AllanParameters::n, &AllanParameters::n_reason, &AllanParameters::n_limit},
    {"flicker_noise", "B", "flicker noise", &AllanParameters::b, &AllanParameters::b_reason, &AllanParameters::b_limit},
    {"random_walk", "K", "random walk", &AllanParameters::k, &AllanParameters::k_reason, &AllanParameters::k_limit},
    {"linear_drift", "R", "drift", &AllanParameters::r, &AllanParameters::r_reason, &AllanParameters::r_limit},
};

class Coefficients {
 public:
  Coefficients(const CompositeBasis& basis, const CompositeSearchResult& found, double unit)
      : basis_(basis), found_(found), unit_(unit), distance_(basis, found.curve, found.delta) {}

  void store(const Term& term, AllanParameters& result) const;
  [[nodiscard]] double flicker_tau() const;

 private:
  /// What of a model is the term's coefficient; nothing where it holds none.
  [[nodiscard]] std::optional<CompositeQuantity> quantity(const Term& term, const Composite& model) const;
  [[nodiscard]] Interval interval(const CompositeFit& fit, const CompositeQuantity& quantity) const;
  [[nodiscard]] double upper_limit(const Term& term, const CompositeFit& without) const;
  [[nodiscard]] std::string names(bool with, const Term& term) const;
  [[nodiscard]] bool as_good(const CompositeFit& fit) const {
    return fit.cost() <= found_.fits.front().cost() + kAsGood;
  }
  /// Of a squared level's logarithm.
  [[nodiscard]] double level(double log_square) const { return unit_ * std::exp(0.5 * log_square); }

  const CompositeBasis& basis_;
  const CompositeSearchResult& found_;
  double unit_;
  CompositeDistance distance_;
};

std::optional<CompositeQuantity> Coefficients::quantity(const Term& term, const Composite& model) const {
  CompositeQuantity result;
  const double record_s = static_cast<double>(basis_.table().samples()) * basis_.dt_s();
  for (std::size_t c = 0; c < model.size(); ++c) {
    const std::string_view name = basis_.kinds()[model[c].kind].kind->name;
    if (term.kind == "white_noise" ? basis_.is_fast(model[c]) : name == term.kind) {
      result.components.push_back(c);
      result.of.push_back(term.kind == "white_noise" ? Of::Density : Of::Square);
    } else if (term.kind == "random_walk" && name == "gauss_markov" &&
               std::exp(model[c].log_shape[0]) * record_s < 2.0) {
      result.components.push_back(c);
      result.of.push_back(Of::Walk);
    }
  }
  return result.components.empty() ? std::nullopt : std::optional(std::move(result));
}

Interval Coefficients::interval(const CompositeFit& fit, const CompositeQuantity& quantity) const {
  const double error = distance_.standard_error(fit.model, quantity);
  Interval found{};
  if (error < kCurvatureHolds) {
    const double value = distance_.value(fit.model, quantity);
    const double half = std::sqrt(kRise95) * error;
    found = {value - half, value + half};
  } else {
    found = distance_.profile(fit.model, quantity, kRise95);
  }
  // The misfit of one scale is that of its neighbours, and may be that of all of them.
  return {found.low - distance_.delta(), found.high + distance_.delta()};
}

double Coefficients::upper_limit(const Term& term, const CompositeFit& without) const {
  std::size_t kind = 0;
  while (kind < basis_.kinds().size() && basis_.kinds()[kind].kind->name != term.kind) {
    ++kind;
  }
  if (kind == basis_.kinds().size()) {
    return kUnbounded;
  }
  Composite model = without.model;
  model.push_back({kind, 0.0, {}});
  // From where the term takes a thousandth of some scale's variance.
  LogColumn column;
  basis_.column(model.back(), false, column);
  const Eigen::VectorXd& y = distance_.log_variance();
  double start = kUnbounded;
  for (Eigen::Index j = 0; j < y.size(); ++j) {
    start = std::min(start, y(j) - column.value(distance_.used()[static_cast<std::size_t>(j)]));
  }
  model.back().log_square = start + std::log(1e-3);
  const double least = std::min(without.distance, distance_.minimise(model));
  const CompositeQuantity quantity{{model.size() - 1}, {Of::Square}};
  double low = std::max(model.back().log_square, start + std::log(1e-3));
  double low_root = 0.0;
  const double wanted = std::sqrt(kRise95OneSided);
  for (double step = 2.0; step < 64.0; step *= 1.5) {
    const double high = low + step;
    double high_root = std::sqrt(std::max(distance_.minimise(model, CompositeConstraint{quantity, high}) - least, 0.0));
    if (high_root <= wanted) {
      low = high;
      low_root = high_root;
      continue;
    }
    double outside = high;
    for (int i = 0; i < 8 && outside - low > 0.02; ++i) {
      const double fraction = std::clamp((wanted - low_root) / (high_root - low_root), 0.15, 0.85);
      const double middle = low + fraction * (outside - low);
      const double root =
          std::sqrt(std::max(distance_.minimise(model, CompositeConstraint{quantity, middle}) - least, 0.0));
      (root > wanted ? outside : low) = middle;
      (root > wanted ? high_root : low_root) = root;
    }
    return level(outside);
  }
  return kUnbounded;
}

std::string Coefficients::names(bool with, const Term& term) const {
  std::string text;
  for (const CompositeFit& fit : found_.fits) {
    if (as_good(fit) && quantity(term, fit.model).has_value() == with) {
      const std::string name = composite_name(basis_, fit.model);
      if (text.find(name) == std::string::npos) {
        text += (text.empty() ? "" : ", ") + name;
      }
    }
  }
  return text;
}

void Coefficients::store(const Term& term, AllanParameters& result) const {
  std::optional<Estimate> estimate;
  bool with = false;  // among the models that are as good as the best
  bool without = false;
  for (const CompositeFit& fit : found_.fits) {
    const std::optional<CompositeQuantity> here = quantity(term, fit.model);
    (here ? with : without) = (here ? with : without) || as_good(fit);
    if (!here) {
      continue;
    }
    const Interval squares = interval(fit, *here);
    const Interval levels{level(squares.low), level(squares.high)};
    if (!estimate) {
      estimate = Estimate{level(distance_.value(fit.model, *here)), levels};
    } else {
      estimate->ci95 = {std::min(estimate->ci95.low, levels.low), std::max(estimate->ci95.high, levels.high)};
    }
  }
  const std::string title(term.title);
  if (!with) {
    result.*term.limit = 0.0;
    for (const CompositeFit& fit : found_.fits) {
      if (!as_good(fit)) {
        continue;
      }
      result.*term.limit = std::max(result.*term.limit, upper_limit(term, fit));
    }
    result.*term.reason = "The curve is described without " + title + ", by " + names(false, term) + ".";
  } else if (without) {
    result.*term.limit = estimate->ci95.high;
    result.*term.reason = "Models with " + title + " (" + names(true, term) + ") and without it (" +
                          names(false, term) + ") describe the curve equally well.";
  } else if (!(estimate->ci95.low > 0.0)) {
    result.*term.limit = estimate->ci95.high;
    result.*term.reason = "The curve bounds the level of " + title + " from above only.";
  } else {
    result.*term.estimate = estimate;
  }
}

double Coefficients::flicker_tau() const {
  const Composite& model = found_.fits.front().model;
  const Eigen::VectorXd all = basis_.variance(model);
  LogColumn column;
  double most = 0.0;
  double tau_s = 0.0;
  for (const Component& component : model) {
    if (basis_.kinds()[component.kind].kind->name != "flicker_noise") {
      continue;
    }
    basis_.column(component, false, column);
    for (Eigen::Index j = 0; j < all.size(); ++j) {
      const double share = std::exp(component.log_square + column.value(j)) / all(j);
      if (share > most) {
        most = share;
        tau_s = static_cast<double>(basis_.table().half()[static_cast<std::size_t>(j)]) * basis_.dt_s();
      }
    }
  }
  return tau_s;
}

}  // namespace

AllanParameters ieee952_coefficients(const CompositeBasis& basis, const CompositeSearchResult& found, double unit) {
  AllanParameters result;
  if (found.fits.empty() || found.delta < 0.0 || found.delta > kMostDiscrepancy) {
    result.q_reason = result.n_reason = result.b_reason = result.k_reason = result.r_reason =
        "These terms do not describe the curve: no sum of the registered processes comes within 5 % of it.";
    return result;
  }
  const Coefficients coefficients(basis, found, unit);
  for (const Term& term : kTerms) {
    coefficients.store(term, result);
  }
  if (result.b) {
    result.b_tau_s = coefficients.flicker_tau();
  }
  return result;
}

}  // namespace driftlab
