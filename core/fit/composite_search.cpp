#include "core/fit/composite_search.hpp"

#include "core/fit/j_test.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/sort_keeping_ties.hpp"
#include "core/variance/nonnegative_least_squares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostComponents = 8;
constexpr double kPrune = 5.0;
constexpr double kNearlyAsGood = 4.5;
/// Difference of L below which two fits of one structure are one.
constexpr double kSame = 0.05;
/// Models of a step that are polished in all their shapes, after all of them were in the new one's.
constexpr std::size_t kPolished = 4;
/// A model of so many components that is so far out, in degrees of freedom, will not be accepted with the rest.
constexpr std::size_t kHopelessFrom = 4;
constexpr double kHopeless = 4.0;
/// Components after which the periodogram is asked for lines, if the model is rejected.
constexpr std::size_t kBeforeLines = 2;
constexpr std::size_t kSpare = 4;  // scales that a model must leave
/// Of a resonance at a line, where its polishing starts.
constexpr std::array<double, 5> kQualities{0.7, 1.5, 4.0, 12.0, 40.0};

double pruned_cost(const CompositeFit& fit) { return fit.distance + kPrune * static_cast<double>(fit.parameters); }

class Search {
 public:
  Search(const CompositeBasis& basis, const CompositeCurve& curve) : basis_(basis), curve_(curve) {}

  /// Steps forward and back under one S; every model that was polished is left in `seen`.
  CompositeFit run(const CompositeDistance& distance, std::vector<CompositeFit>& seen) const;
  /// The shapes of the first `settled` components stay as they are.
  CompositeFit polished(const CompositeDistance& distance, Composite model, std::size_t settled = 0) const;

 private:
  struct Start {
    Composite model;
    double squared = std::numeric_limits<double>::infinity();
  };
  enum class Offer { Noise, NoiseAndLines, Drift };
  std::vector<Start> starts(const CompositeDistance& distance, const Composite& current, Offer what) const;
  /// The best model of one component more, by cost.
  std::optional<CompositeFit> step(const CompositeDistance& distance, const Composite& current, Offer what,
                                   std::vector<CompositeFit>& seen) const;
  void offer(const Eigen::MatrixXd& old, const Component& next, const Eigen::VectorXd& log_column,
             const CompositeDistance& distance, const Composite& current, Start& best) const;
  [[nodiscard]] bool is_trend(std::size_t kind) const { return basis_.kinds()[kind].kind->slope != nullptr; }
  CompositeFit forward(const CompositeDistance& distance, CompositeFit current, std::vector<CompositeFit>& seen) const;
  CompositeFit pruned(const CompositeDistance& distance, CompositeFit current, std::vector<CompositeFit>& seen) const;
  /// With components that have a shape exchanged for such without, while that lowers the cost: what stood in for white
  /// noise before quantization noise was found is white noise.
  CompositeFit simplified(const CompositeDistance& distance, CompositeFit current,
                          std::vector<CompositeFit>& seen) const;
  Eigen::MatrixXd whitened_shares(const CompositeDistance& distance, const Composite& model) const;

  const CompositeBasis& basis_;
  const CompositeCurve& curve_;
  mutable std::optional<std::vector<SpectralLine>> lines_;
};

CompositeFit Search::polished(const CompositeDistance& distance, Composite model, std::size_t settled) const {
  CompositeFit fit;
  fit.distance = distance.minimise(model, std::nullopt, settled);
  fit.parameters = parameter_count(basis_, model);
  const double dof = static_cast<double>(distance.rows()) - static_cast<double>(fit.parameters);
  fit.p = dof > 0.0 ? chi_squared_tail(fit.distance, dof) : 0.0;
  fit.model = std::move(model);
  return fit;
}

void Search::offer(const Eigen::MatrixXd& old, const Component& next, const Eigen::VectorXd& log_column,
                   const CompositeDistance& distance, const Composite& current, Start& best) const {
  const Eigen::Index rows = distance.rows();
  Eigen::MatrixXd columns(rows, old.cols() + 1);
  columns.leftCols(old.cols()) = old;
  const Eigen::VectorXd relative = (log_column(distance.used()) - distance.log_variance()).array().exp();
  columns.col(old.cols()) = distance.whitening().triangularView<Eigen::Lower>() * relative;
  const Eigen::VectorXd target = distance.whitening() * Eigen::VectorXd::Ones(rows);
  const NonnegativeSolution solution = nonnegative_least_squares(columns, target);
  if (solution.squared_residual >= best.squared || !(solution.x(old.cols()) > 0.0)) {
    return;
  }
  best.squared = solution.squared_residual;
  best.model.clear();
  for (std::size_t c = 0; c < current.size(); ++c) {
    const double factor = solution.x(static_cast<Eigen::Index>(c));
    best.model.push_back(current[c]);
    best.model.back().log_square += std::log(std::max(factor, 1e-3));
  }
  best.model.push_back(next);
  best.model.back().log_square = std::log(solution.x(old.cols()));
}

Eigen::MatrixXd Search::whitened_shares(const CompositeDistance& distance, const Composite& model) const {
  Eigen::MatrixXd shares(distance.rows(), static_cast<Eigen::Index>(model.size()));
  LogColumn column;
  for (std::size_t c = 0; c < model.size(); ++c) {
    basis_.column(model[c], false, column);
    const Eigen::VectorXd relative =
        (column.value(distance.used()) - distance.log_variance()).array() + model[c].log_square;
    shares.col(static_cast<Eigen::Index>(c)) =
        distance.whitening().triangularView<Eigen::Lower>() * relative.array().exp().matrix();
  }
  return shares;
}

std::vector<Search::Start> Search::starts(const CompositeDistance& distance, const Composite& current,
                                          Offer what) const {
  if (what == Offer::NoiseAndLines && !lines_) {
    lines_ = curve_.lines ? curve_.lines() : std::vector<SpectralLine>{};
  }
  const Eigen::MatrixXd old = whitened_shares(distance, current);
  LogColumn column;
  std::vector<Start> all;
  for (std::size_t k = 0; k < basis_.kinds().size(); ++k) {
    const CompositeKind& kind = basis_.kinds()[k];
    const bool present = std::any_of(current.begin(), current.end(), [&](const Component& c) { return c.kind == k; });
    if ((present && !kind.repeats) || is_trend(k) != (what == Offer::Drift) ||
        (kind.at_lines_only && what != Offer::NoiseAndLines)) {
      continue;
    }
    Start best;
    if (kind.at_lines_only) {
      for (const SpectralLine& line : *lines_) {
        if (kind.shapes() == 1 && !line.sharp) {
          continue;
        }
        for (const double quality : kQualities) {
          const double frequency = std::log(line.frequency / basis_.dt_s());
          Component at{k, 0.0, {frequency, std::log(quality)}, frequency};
          for (std::size_t s = 0; s < kind.shapes(); ++s) {
            at.log_shape[s] = std::clamp(at.log_shape[s], kind.log_range[s].first, kind.log_range[s].second);
          }
          basis_.column(at, false, column);
          offer(old, at, column.value, distance, current, best);
          if (kind.shapes() == 1) {
            break;
          }
        }
      }
    } else {
      const Eigen::MatrixXd& scanned = basis_.scanned(k);
      for (Eigen::Index i = 0; i < scanned.cols(); ++i) {
        const Component at{k, 0.0, {kind.shapes() > 0 ? basis_.scan(k)[static_cast<std::size_t>(i)] : 0.0}};
        offer(old, at, scanned.col(i), distance, current, best);
      }
    }
    if (std::isfinite(best.squared)) {
      all.push_back(std::move(best));
    }
  }
  return all;
}

std::optional<CompositeFit> Search::step(const CompositeDistance& distance, const Composite& current, Offer what,
                                         std::vector<CompositeFit>& seen) const {
  std::vector<CompositeFit> quick;
  for (Start& start : starts(distance, current, what)) {
    const std::size_t parameters = parameter_count(basis_, start.model);
    if (parameters + kSpare <= static_cast<std::size_t>(distance.rows()) && parameters <= kMostCompositeParameters) {
      quick.push_back(polished(distance, std::move(start.model), current.size()));
    }
  }
  std::sort(quick.begin(), quick.end(),
            [](const CompositeFit& a, const CompositeFit& b) { return a.cost() < b.cost(); });
  std::optional<CompositeFit> best;
  for (std::size_t i = 0; i < quick.size() && i < kPolished; ++i) {
    CompositeFit fit = polished(distance, std::move(quick[i].model));
    seen.push_back(fit);
    if (!best || fit.cost() < best->cost()) {
      best = std::move(fit);
    }
  }
  return best;
}

CompositeFit Search::forward(const CompositeDistance& distance, CompositeFit current,
                             std::vector<CompositeFit>& seen) const {
  bool lines = false;
  while (current.model.size() < kMostComponents) {
    lines = lines || (current.model.size() >= kBeforeLines && current.p <= kRejected);
    std::optional<CompositeFit> next = step(distance, current.model, lines ? Offer::NoiseAndLines : Offer::Noise, seen);
    if (next && (current.model.empty() || next->cost() < current.cost())) {
      current = std::move(*next);
      if (current.model.size() >= kHopelessFrom &&
          current.distance > kHopeless * static_cast<double>(distance.rows())) {
        break;
      }
    } else if (!lines && current.p <= kRejected) {
      lines = true;
    } else {
      break;
    }
  }
  return current;
}

CompositeFit Search::pruned(const CompositeDistance& distance, CompositeFit current,
                            std::vector<CompositeFit>& seen) const {
  for (bool fell = true; fell && current.model.size() > 1;) {
    fell = false;
    CompositeFit best;
    double least = 0.0;
    for (std::size_t c = 0; c < current.model.size(); ++c) {
      Composite without = current.model;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(c));
      CompositeFit fit = polished(distance, std::move(without));
      seen.push_back(fit);
      const double change =
          fit.distance - current.distance - kPrune * static_cast<double>(current.parameters - fit.parameters);
      if (change < least) {
        least = change;
        best = std::move(fit);
        fell = true;
      }
    }
    if (fell) {
      current = std::move(best);
    }
  }
  return current;
}

CompositeFit Search::simplified(const CompositeDistance& distance, CompositeFit current,
                                std::vector<CompositeFit>& seen) const {
  for (bool fell = true; fell;) {
    fell = false;
    for (std::size_t c = 0; c < current.model.size() && !fell; ++c) {
      if (basis_.kinds()[current.model[c].kind].shapes() == 0) {
        continue;
      }
      Composite rest = current.model;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(c));
      const Eigen::MatrixXd old = whitened_shares(distance, rest);
      for (std::size_t k = 0; k < basis_.kinds().size() && !fell; ++k) {
        const CompositeKind& kind = basis_.kinds()[k];
        const bool present = std::any_of(rest.begin(), rest.end(), [&](const Component& one) { return one.kind == k; });
        if (kind.shapes() > 0 || present || is_trend(k)) {
          continue;
        }
        Start start;
        offer(old, {k, 0.0, {}}, basis_.scanned(k).col(0), distance, rest, start);
        if (start.model.empty()) {
          continue;
        }
        CompositeFit fit = polished(distance, std::move(start.model));
        seen.push_back(fit);
        if (fit.cost() < current.cost()) {
          current = std::move(fit);
          fell = true;
        }
      }
    }
  }
  return current;
}

CompositeFit Search::run(const CompositeDistance& distance, std::vector<CompositeFit>& seen) const {
  CompositeFit fit = simplified(distance, pruned(distance, forward(distance, {}, seen), seen), seen);
  if (fit.p <= kRejected) {
    std::optional<CompositeFit> with_drift = step(distance, fit.model, Offer::Drift, seen);
    if (with_drift && with_drift->cost() < fit.cost()) {
      fit = simplified(distance, pruned(distance, forward(distance, std::move(*with_drift), seen), seen), seen);
    }
  }
  return fit;
}

}  // namespace

CompositeSearchResult search_composite(const CompositeBasis& basis, const CompositeCurve& curve,
                                       const RunControl& control) {
  const Search search(basis, curve);
  CompositeCovariance covariance(basis, curve);
  CompositeSearchResult result;
  result.curve = covariance.of_mixture();
  std::vector<CompositeFit> seen;
  CompositeFit best;
  for (const double delta : kDiscrepancyLadder) {
    if (control.stop.stop_requested()) {
      return result;
    }
    seen.clear();
    best = search.run(CompositeDistance(basis, result.curve, delta), seen);
    if (best.model.empty()) {
      break;
    }
    result.delta = delta;
    result.accepted = delta == 0.0 && best.p > kRejected;
    if (best.p > kRejected) {
      break;
    }
    result.delta = -1.0;
  }
  if (best.model.empty()) {
    return result;
  }
  // Once more under the S of the model itself.
  result.curve = covariance.of_model(best.model);
  const CompositeDistance distance(basis, result.curve, std::max(result.delta, 0.0));
  const CompositeFit first = search.polished(distance, best.model);
  result.fits.push_back(first);
  for (CompositeFit& other : seen) {
    if (other.cost() > best.cost() + 3.0 * kNearlyAsGood || other.model.empty()) {
      continue;
    }
    result.fits.push_back(search.polished(distance, std::move(other.model)));
  }
  // The pruned model stands first unless another is better by more than the difference of the two penalties.
  sort_keeping_ties(result.fits,
                    [&](const CompositeFit& a, const CompositeFit& b) { return pruned_cost(a) < pruned_cost(b); });
  std::vector<CompositeFit> kept;
  for (CompositeFit& fit : result.fits) {
    const bool again = std::any_of(kept.begin(), kept.end(), [&](const CompositeFit& other) {
      return std::fabs(other.distance - fit.distance) < kSame &&
             composite_name(basis, other.model) == composite_name(basis, fit.model);
    });
    if (kept.empty() || (!again && fit.cost() < kept.front().cost() + kNearlyAsGood && fit.p > kRejected)) {
      kept.push_back(std::move(fit));
    }
  }
  result.fits = std::move(kept);
  return result;
}

}  // namespace driftlab
