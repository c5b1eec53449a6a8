#include "core/fit/gmwm.hpp"

#include "core/fit/levenberg_marquardt.hpp"
#include "core/fit/subset_least_squares.hpp"
#include "core/process/dense.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace driftlab {
namespace {

constexpr int kGridOne = 48;
constexpr int kGridThree = 20;

/// One shape of the structure: which parameter of which process it is, and where to look for it.
struct ShapeSlot {
  std::size_t process = 0;
  std::size_t parameter = 0;
  double log_low = 0.0;
  double log_high = 0.0;
};

std::span<double> entries(Eigen::VectorXd& vector) { return {vector.data(), static_cast<std::size_t>(vector.size())}; }

class Search {
 public:
  Search(const WaveletMoments& moments, const ModelStructure& structure, const MomentWeights& weights)
      : moments_(moments), structure_(structure), weights_(weights), target_(weights.whitened(moments.nu)) {
    for (std::size_t k = 0; k < structure.kinds.size(); ++k) {
      for (std::size_t shape = 0; shape < structure.kinds[k]->shape_count(); ++shape) {
        const auto [low, high] = structure.kinds[k]->shape_range(shape, moments.dt_s, moments.samples);
        slots_.push_back({k, shape + 1, std::log(low), std::log(high)});
      }
    }
    fixed_.resize(target_.size(), static_cast<Eigen::Index>(structure.kinds.size()));
    for (std::size_t k = 0; k < structure.kinds.size(); ++k) {
      if (!structure.kinds[k]->has_shape()) {
        fixed_.col(static_cast<Eigen::Index>(k)) = column(k, {1.0});
      }
    }
  }

  [[nodiscard]] std::size_t shapes() const { return slots_.size(); }
  [[nodiscard]] const std::vector<ShapeSlot>& slots() const { return slots_; }
  [[nodiscard]] Eigen::Index scales() const { return target_.size(); }

  /// The parameters of a process: 1 for its level, and its shapes, whose logarithms stand from slot `first` on.
  using Values = std::array<double, kMostParameters>;
  [[nodiscard]] Values values(std::size_t first, const Eigen::VectorXd& log_shapes) const {
    Values p{1.0};
    for (std::size_t s = first; s < slots_.size() && slots_[s].process == slots_[first].process; ++s) {
      p[slots_[s].parameter] = std::exp(log_shapes(static_cast<Eigen::Index>(s)));
    }
    return p;
  }
  /// The first slot of the process that slot s belongs to.
  [[nodiscard]] std::size_t first_slot(std::size_t s) const { return s + 1 - slots_[s].parameter; }

  /// Whitened wavelet variance of process k at the parameters p.
  [[nodiscard]] Eigen::VectorXd column(std::size_t k, const Values& p) const {
    const ProcessKind* kind = structure_.kinds[k];
    Eigen::VectorXd raw(static_cast<Eigen::Index>(moments_.half.size()));
    curve_of(*kind, {p.data(), kind->parameters.size()}, moments_, entries(raw));
    return weights_.whitened(raw);
  }

  /// d column / d log_shape of slot s.
  [[nodiscard]] Eigen::VectorXd column_slope(std::size_t s, const Eigen::VectorXd& log_shapes) const {
    const ProcessKind* kind = structure_.kinds[slots_[s].process];
    const Values p = values(first_slot(s), log_shapes);
    const std::size_t count = kind->parameters.size();
    Eigen::VectorXd raw(static_cast<Eigen::Index>(moments_.half.size()));
    std::vector<double> gradient(moments_.half.size() * count);
    curve_of(*kind, {p.data(), count}, moments_, entries(raw), gradient);
    for (std::size_t j = 0; j < moments_.half.size(); ++j) {
      raw(static_cast<Eigen::Index>(j)) = gradient[j * count + slots_[s].parameter] * p[slots_[s].parameter];
    }
    return weights_.whitened(raw);
  }

  [[nodiscard]] Eigen::MatrixXd design(const Eigen::VectorXd& log_shapes) const {
    Eigen::MatrixXd a = fixed_;
    for (std::size_t s = 0; s < slots_.size(); s += structure_.kinds[slots_[s].process]->shape_count()) {
      a.col(static_cast<Eigen::Index>(slots_[s].process)) = column(slots_[s].process, values(s, log_shapes));
    }
    return a;
  }

  [[nodiscard]] const Eigen::VectorXd& target() const { return target_; }
  [[nodiscard]] const Eigen::MatrixXd& fixed() const { return fixed_; }

  [[nodiscard]] Eigen::VectorXd clamped(const Eigen::VectorXd& log_shapes) const {
    Eigen::VectorXd inside = log_shapes;
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      const auto i = static_cast<Eigen::Index>(s);
      inside(i) = std::clamp(inside(i), slots_[s].log_low, slots_[s].log_high);
    }
    return inside;
  }

 private:
  const WaveletMoments& moments_;
  const ModelStructure& structure_;
  const MomentWeights& weights_;
  Eigen::VectorXd target_;
  Eigen::MatrixXd fixed_;
  std::vector<ShapeSlot> slots_;
};

/// The best levels where a search has last looked: it asks for the slope where it has just asked for the value.
struct LastLook {
  Eigen::VectorXd at;
  Eigen::MatrixXd design;
  SubsetSolution levels;
};

/// The projected residual as a function of the logarithms of the shapes.
void projected_residual(const Search& search, LastLook& last, const Eigen::VectorXd& log_shapes,
                        Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
  const Eigen::VectorXd at = search.clamped(log_shapes);
  if (last.at.size() != at.size() || last.at != at) {
    last.at = at;
    last.design = search.design(at);
    last.levels = subset_least_squares(last.design, search.target());
  }
  const Eigen::MatrixXd& a = last.design;
  const SubsetSolution& levels = last.levels;
  residuals = search.target() - a * levels.x;
  if (jacobian == nullptr) {
    return;
  }
  std::vector<Eigen::Index> active;
  for (Eigen::Index k = 0; k < levels.x.size(); ++k) {
    if (levels.x(k) > 0.0) {
      active.push_back(k);
    }
  }
  Eigen::MatrixXd basis(a.rows(), static_cast<Eigen::Index>(active.size()));
  for (std::size_t k = 0; k < active.size(); ++k) {
    basis.col(static_cast<Eigen::Index>(k)) = a.col(active[k]);
  }
  Eigen::MatrixXd slopes(a.rows(), static_cast<Eigen::Index>(search.shapes()));
  for (std::size_t s = 0; s < search.shapes(); ++s) {
    const auto process = static_cast<Eigen::Index>(search.slots()[s].process);
    const auto column = static_cast<Eigen::Index>(s);
    slopes.col(column) = levels.x(process) * search.column_slope(s, at);
  }
  *jacobian = -slopes;
  if (!active.empty()) {
    *jacobian += basis * least_squares(basis, slopes);
  }
}

struct ScannedStart {
  Eigen::VectorXd log_shapes;
  double objective = std::numeric_limits<double>::infinity();
};

/// The columns of one process with shapes in the matrix of a scan.
struct GridBlock {
  std::size_t slot = 0;      ///< first of its slots
  std::size_t shapes = 0;    ///< and how many it has
  Eigen::Index first = 0;    ///< column
  Eigen::Index columns = 0;  ///< one per combination of its shapes' grid points
  bool repeats = false;      ///< the process before it is of the same kind
};

std::vector<GridBlock> grid_blocks(const Search& search, const ModelStructure& structure, int points) {
  std::vector<GridBlock> blocks;
  Eigen::Index next = search.fixed().cols();
  for (std::size_t slot = 0; slot < search.shapes();) {
    const ProcessKind* kind = structure.kinds[search.slots()[slot].process];
    GridBlock block{slot, kind->shape_count(), next, 1, false};
    for (std::size_t s = 0; s < block.shapes; ++s) {
      block.columns *= points;
    }
    block.repeats = slot > 0 && structure.kinds[search.slots()[slot - 1].process] == kind;
    next += block.columns;
    slot += block.shapes;
    blocks.push_back(block);
  }
  return blocks;
}

/// Scans all combinations of grid points (rising within one kind) and keeps the best few that are not neighbours.
std::vector<ScannedStart> scan(const Search& search, const ModelStructure& structure) {
  const std::size_t shapes = search.shapes();
  const bool several = std::any_of(structure.kinds.begin(), structure.kinds.end(),
                                   [](const ProcessKind* kind) { return kind->shape_count() > 1; });
  const int points = shapes > 2 || several ? kGridThree : kGridOne;
  const auto at = [&](std::size_t s, int g) {
    const ShapeSlot& slot = search.slots()[s];
    return slot.log_low + (slot.log_high - slot.log_low) * g / (points - 1);
  };
  // One Gram matrix over the fixed columns and every grid column; processes of one kind share theirs. A process with
  // several shapes has a column for each of their combinations, the last shape counted fastest.
  const Eigen::Index fixed = search.fixed().cols();
  const std::vector<GridBlock> blocks = grid_blocks(search, structure, points);
  Eigen::MatrixXd all(search.scales(), blocks.empty() ? fixed : blocks.back().first + blocks.back().columns);
  all.leftCols(fixed) = search.fixed();
  for (const GridBlock& block : blocks) {
    all.col(static_cast<Eigen::Index>(search.slots()[block.slot].process)).setZero();
    if (block.repeats) {
      all.middleCols(block.first, block.columns) = all.middleCols(block.first - block.columns, block.columns);
      continue;
    }
    Eigen::VectorXd log_shapes(static_cast<Eigen::Index>(shapes));
    for (Eigen::Index g = 0; g < block.columns; ++g) {
      Eigen::Index rest = g;
      for (std::size_t s = block.slot + block.shapes; s-- > block.slot; rest /= points) {
        log_shapes(static_cast<Eigen::Index>(s)) = at(s, static_cast<int>(rest % points));
      }
      all.col(block.first + g) =
          search.column(search.slots()[block.slot].process, search.values(block.slot, log_shapes));
    }
  }
  const GramProblem problem(all, search.target());
  std::vector<ScannedStart> candidates;
  std::vector<int> index(shapes, 0);
  std::vector<std::vector<int>> tried;
  std::vector<double> value;
  std::vector<Eigen::Index> picked(static_cast<std::size_t>(fixed));
  std::iota(picked.begin(), picked.end(), Eigen::Index{0});
  const auto visit = [&] {
    for (const GridBlock& block : blocks) {
      // fastest (largest beta) first; equal ones are one process
      if (block.repeats && index[block.slot] >= index[block.slot - block.shapes]) {
        return;
      }
    }
    for (const GridBlock& block : blocks) {
      Eigen::Index column = 0;
      for (std::size_t s = block.slot; s < block.slot + block.shapes; ++s) {
        column = column * points + index[s];
      }
      picked[search.slots()[block.slot].process] = block.first + column;
    }
    tried.push_back(index);
    value.push_back(problem.least_residual(picked));
  };
  for (;;) {
    visit();
    std::size_t s = 0;
    while (s < shapes && ++index[s] == points) {
      index[s++] = 0;
    }
    if (s == shapes) {
      break;
    }
  }
  std::vector<std::size_t> order(tried.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
  std::vector<std::size_t> kept;
  constexpr std::size_t kKeep = 6;
  for (const std::size_t i : order) {
    const bool fresh = std::none_of(kept.begin(), kept.end(), [&](std::size_t other) {
      int distance = 0;
      for (std::size_t s = 0; s < shapes; ++s) {
        distance = std::max(distance, std::abs(tried[i][s] - tried[other][s]));
      }
      return distance <= 2;
    });
    if (fresh) {
      kept.push_back(i);
    }
    if (kept.size() == kKeep) {
      break;
    }
  }
  for (const std::size_t i : kept) {
    ScannedStart candidate;
    candidate.log_shapes.resize(static_cast<Eigen::Index>(shapes));
    for (std::size_t s = 0; s < shapes; ++s) {
      candidate.log_shapes(static_cast<Eigen::Index>(s)) = at(s, tried[i][s]);
    }
    candidate.objective = value[i];
    candidates.push_back(candidate);
  }
  return candidates;
}

/// By how much one Gauss-Newton step from here promises to lower the squared residual.
double promised_fall(const ResidualFunction& residual, const Eigen::VectorXd& at) {
  Eigen::VectorXd r;
  Eigen::MatrixXd jacobian;
  residual(at, r, &jacobian);
  return (jacobian * least_squares(jacobian, r)).squaredNorm();
}

}  // namespace

void sort_repeats(Model& model) {
  std::sort(model.begin(), model.end(), [](const Process& a, const Process& b) {
    if (a.kind != b.kind) {
      return a.kind < b.kind;  // entries of one registry, in its order
    }
    if ((a.parameters[0] > 0.0) != (b.parameters[0] > 0.0)) {
      return a.parameters[0] > 0.0;
    }
    if (a.parameters.size() > 1 && a.parameters[1] != b.parameters[1]) {  // the first shape: a rate or a frequency
      return a.parameters[1] > b.parameters[1];
    }
    return a.parameters[0] > b.parameters[0];  // equal in all parameters: interchangeable
  });
}

MomentWeights MomentWeights::from_sd(const Eigen::VectorXd& sd) {
  MomentWeights weights;
  weights.diagonal_ = sd.cwiseInverse();
  return weights;
}

MomentWeights MomentWeights::from_covariance(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = sd.cwiseInverse();
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  MomentWeights weights;
  for (double ridge = 0.0;; ridge = ridge == 0.0 ? 1e-12 : 10.0 * ridge) {
    Eigen::MatrixXd raised = correlation;
    raised.diagonal().array() += ridge;
    if (const std::optional<Eigen::MatrixXd> whitening = inverse_cholesky(raised)) {
      weights.whole_ = *whitening * inverse.asDiagonal();
      return weights;
    }
    if (ridge > 1.0) {  // not a covariance at all: what is not finite in it is left to the fit to report
      return from_sd(sd);
    }
  }
}

Eigen::VectorXd MomentWeights::whitened(const Eigen::VectorXd& v) const {
  return diagonal_.size() > 0 ? Eigen::VectorXd(diagonal_.cwiseProduct(v)) : Eigen::VectorXd(whole_ * v);
}

Eigen::MatrixXd MomentWeights::whitening() const {
  return diagonal_.size() > 0 ? Eigen::MatrixXd(diagonal_.asDiagonal()) : whole_;
}

Model GmwmSolution::active() const {
  Model positive;
  std::copy_if(model.begin(), model.end(), std::back_inserter(positive),
               [](const Process& process) { return process.parameters[0] > 0.0; });
  return positive;
}

Eigen::VectorXd modelled_variance(const WaveletMoments& moments, const Model& model) {
  Eigen::VectorXd nu(static_cast<Eigen::Index>(moments.half.size()));
  for (Eigen::Index j = 0; j < nu.size(); ++j) {
    const auto row = static_cast<std::size_t>(j);
    nu(j) = haar_variance(model, moments.half[row], moments.dt_at(row));
  }
  return nu;
}

void curve_of(const ProcessKind& kind, std::span<const double> parameters, const WaveletMoments& moments,
              std::span<double> variance, std::span<double> gradient) {
  const std::size_t count = parameters.size();
  const std::span<const double> half(moments.half);
  const WaveletMoments::Stretch whole{0, half.size(), 0};
  const std::span<const WaveletMoments::Stretch> stretches =
      moments.stretches.empty() ? std::span(&whole, 1) : std::span(moments.stretches);
  for (const auto& [first, rows, like] : stretches) {
    const std::span<double> slopes = gradient.empty() ? gradient : gradient.subspan(first * count, rows * count);
    if (like == first) {
      kind.haar_curve(parameters, half.subspan(first, rows), moments.dt_at(first), variance.subspan(first, rows),
                      slopes);
      continue;
    }
    std::ranges::copy(variance.subspan(like, rows), variance.subspan(first, rows).begin());
    if (!gradient.empty()) {
      std::ranges::copy(gradient.subspan(like * count, rows * count), slopes.begin());
    }
  }
}

GmwmSolution fit_gmwm(const WaveletMoments& moments, const ModelStructure& structure, const MomentWeights& weights) {
  const Search search(moments, structure, weights);
  ScannedStart best;
  GmwmSolution solution;
  solution.converged = true;
  if (search.shapes() == 0) {
    best.log_shapes.resize(0);
  } else {
    LastLook last;
    const auto residual = [&](const Eigen::VectorXd& at, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
      projected_residual(search, last, at, residuals, jacobian);
    };
    LeastSquaresLimits limits{.max_iterations = 60, .gradient_tolerance = 1e-13, .parameter_tolerance = 1e-8};
    for (ScannedStart candidate : scan(search, structure)) {
      // A minimum that three times what its slope promises would not lower below the best is none worth finding.
      if (candidate.objective - 3.0 * promised_fall(residual, candidate.log_shapes) > best.objective) {
        continue;
      }
      limits.function_tolerance = 1e-13 * std::max(1.0, candidate.objective);
      Eigen::VectorXd at = candidate.log_shapes;
      const LeastSquaresOutcome outcome = levenberg_marquardt(residual, search.scales(), limits, at);
      if (outcome.squared_residual < candidate.objective) {
        candidate.objective = outcome.squared_residual;
        candidate.log_shapes = search.clamped(at);
      }
      if (best.log_shapes.size() == 0 || candidate.objective < best.objective) {
        best = candidate;
        solution.converged = outcome.converged;
      }
    }
  }
  const Eigen::MatrixXd design = search.design(best.log_shapes);
  const SubsetSolution levels = subset_least_squares(design, search.target());
  solution.objective = (search.target() - design * levels.x).squaredNorm();
  for (std::size_t k = 0; k < structure.kinds.size(); ++k) {
    Process process{structure.kinds[k], std::vector<double>(structure.kinds[k]->parameters.size(), 0.0)};
    process.parameters[0] = std::sqrt(levels.x(static_cast<Eigen::Index>(k)));
    for (std::size_t s = 0; s < search.shapes(); ++s) {
      if (search.slots()[s].process == k) {
        process.parameters[search.slots()[s].parameter] = std::exp(best.log_shapes(static_cast<Eigen::Index>(s)));
      }
    }
    solution.model.push_back(std::move(process));
  }
  sort_repeats(solution.model);
  return solution;
}

}  // namespace driftlab
