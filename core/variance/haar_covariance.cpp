#include "core/variance/haar_covariance.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace driftlab {
namespace {

constexpr std::size_t kNodes = 6;
/// A stretch this short is summed lag by lag.
constexpr double kWhole = 10.0;

/// Legendre polynomials P_0 .. P_{kNodes-1} at t.
std::array<double, kNodes> legendre(double t) {
  std::array<double, kNodes> p{1.0, t};
  for (std::size_t d = 2; d < kNodes; ++d) {
    const auto k = static_cast<double>(d);
    p[d] = ((2.0 * k - 1.0) * t * p[d - 1] - (k - 1.0) * p[d - 2]) / k;
  }
  return p;
}

/// Nodes (whole, from 0) and weights for the sum of a smooth function over `length` consecutive lags: exact for
/// polynomials of degree kNodes - 1, and nearly so up to twice that, for the nodes are Gauss-Legendre's rounded.
struct SumRule {
  std::array<double, kNodes> node{};
  std::array<double, kNodes> weight{};

  explicit SumRule(double length) {
    constexpr std::array<double, kNodes> kGauss{-0.93246951420315203, -0.66120938646626451, -0.23861918608319691,
                                                0.23861918608319691,  0.66120938646626451,  0.93246951420315203};
    Eigen::Matrix<double, kNodes, kNodes> basis;
    for (std::size_t k = 0; k < kNodes; ++k) {
      node[k] = std::round(0.5 * length * (1.0 + kGauss[k]) - 0.5);
      const auto p = legendre((2.0 * node[k] + 1.0) / length - 1.0);
      for (std::size_t d = 0; d < kNodes; ++d) {
        basis(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(k)) = p[d];
      }
    }
    Eigen::Matrix<double, kNodes, 1> moment = Eigen::Matrix<double, kNodes, 1>::Zero();
    moment(0) = length;
    if (length <= 512.0) {  // above, the sums of the others are below 10^-5 of the first
      moment.setZero();
      for (double h = 0.0; h < length; h += 1.0) {
        const auto p = legendre((2.0 * h + 1.0) / length - 1.0);
        for (std::size_t d = 0; d < kNodes; ++d) {
          moment(static_cast<Eigen::Index>(d)) += p[d];
        }
      }
    }
    const Eigen::Matrix<double, kNodes, 1> solved = basis.partialPivLu().solve(moment);
    std::copy(solved.begin(), solved.end(), weight.begin());
  }
};

/// Collects lags and the number of lags each stands for.
class LagPlan {
 public:
  LagPlan(double mi, const std::optional<Ringing>& ringing, std::map<double, SumRule>& rules)
      : first_(std::max(1.0, std::ceil(0.5 * mi))), ringing_(ringing), rules_(rules) {}

  void single(double lag) {
    lag_.push_back(lag);
    weight_.push_back(1.0);
  }

  /// The lags strictly between two kinks (`end` a kink too) or up to and including the last lag. Near a kink a stretch
  /// is m_i/2 long, away from it it grows fourfold in distance; where the process rings none is longer than that.
  void gap(double start, double end, bool end_is_kink) {
    const double low = start + 1.0;
    const double high = end_is_kink ? end - 1.0 : end;
    if (high < low) {
      return;
    }
    std::vector<double> cuts;  // a stretch ends with each of these
    const double reach = end_is_kink ? 0.5 * (high - low) : high - low;
    std::vector<double> distance;
    for (double d = first_; d <= reach + 1.0; d *= 4.0) {
      distance.push_back(d);
    }
    for (const double d : distance) {
      cuts.push_back(std::floor(low + d) - 1.0);
    }
    if (end_is_kink) {
      if (!distance.empty()) {
        cuts.push_back(std::floor(0.5 * (low + high)));
      }
      for (auto d = distance.rbegin(); d != distance.rend(); ++d) {
        cuts.push_back(std::ceil(high - *d));
      }
    }
    if (ringing_) {
      const double step = std::max(1.0, std::floor(ringing_->length));
      for (double d = step; d <= std::min(ringing_->reach + step, reach); d += step) {
        cuts.push_back(low + d - 1.0);
        if (end_is_kink) {
          cuts.push_back(high - d);
        }
      }
      std::sort(cuts.begin(), cuts.end());
    }
    cuts.push_back(high);
    double from = low;
    for (const double cut : cuts) {
      if (cut >= from) {
        stretch(from, cut - from + 1.0);
        from = cut + 1.0;
      }
    }
  }

  std::vector<double>& lag() { return lag_; }
  std::vector<double>& weight() { return weight_; }

 private:
  void stretch(double from, double length) {
    if (length <= kWhole) {
      for (double h = 0.0; h < length; h += 1.0) {
        single(from + h);
      }
      return;
    }
    const SumRule& rule = rules_.try_emplace(length, length).first->second;
    for (std::size_t k = 0; k < kNodes; ++k) {
      lag_.push_back(from + rule.node[k]);
      weight_.push_back(rule.weight[k]);
    }
  }

  double first_;
  std::optional<Ringing> ringing_;
  std::map<double, SumRule>& rules_;
  std::vector<double> lag_;
  std::vector<double> weight_;
};

/// The rules depend on the lengths alone, which repeat from pair to pair.
void choose_lags(double mi, double mj, double last, const std::optional<Ringing>& ringing,
                 std::map<double, SumRule>& rules, std::vector<double>& lag, std::vector<double>& weight) {
  std::vector<double> kinks;
  for (const double kink : {0.0, mi, mj - mi, mj, mj + mi}) {
    if (kink <= last) {
      kinks.push_back(kink);
    }
  }
  std::sort(kinks.begin(), kinks.end());
  kinks.erase(std::unique(kinks.begin(), kinks.end()), kinks.end());
  LagPlan plan(mi, ringing, rules);
  for (std::size_t k = 0; k < kinks.size(); ++k) {
    plan.single(kinks[k]);
    const bool more = k + 1 < kinks.size();
    plan.gap(kinks[k], more ? kinks[k + 1] : last, more);
  }
  lag = std::move(plan.lag());
  weight = std::move(plan.weight());
}

}  // namespace

struct HaarCovariance::Rules {
  std::map<double, SumRule> of;  ///< by length
};

HaarCovariance::~HaarCovariance() = default;
HaarCovariance::HaarCovariance(HaarCovariance&& other) noexcept = default;
HaarCovariance& HaarCovariance::operator=(HaarCovariance&& other) noexcept = default;

HaarCovariance::HaarCovariance(std::span<const std::size_t> half, std::size_t samples, double dt_s)
    : half_(half.begin(), half.end()),
      samples_(static_cast<double>(samples)),
      dt_s_(dt_s),
      rules_(std::make_unique<Rules>()) {
  pairs_.resize(half_.size() * (half_.size() + 1) / 2);
  thinned_.resize(half_.size());
  stride_.resize(half_.size());
}

/// The widest and the finest of what rings in a model.
std::optional<Ringing> HaarCovariance::ringing_of(const Model& model) const {
  std::optional<Ringing> all;
  for (const Process& process : model) {
    if (process.kind->ringing != nullptr) {
      const Ringing own = process.kind->ringing(process.parameters, dt_s_);
      all = all ? Ringing{std::max(all->reach, own.reach), std::min(all->length, own.length)} : own;
    }
  }
  return all;
}

HaarCovariance::Pair& HaarCovariance::pair(std::size_t i, std::size_t j, const Model& model) {
  const std::optional<Ringing> ringing = ringing_of(model);
  Pair& plan = ringing ? ringing_pair_ : pairs_[j * (j + 1) / 2 + i];
  if (ringing) {  // where and how finely depends on its parameters: this plan is not kept
    plan = {};
  }
  if (!plan.lag.empty()) {
    return plan;
  }
  const double mi = half_[i];
  const double mj = half_[j];
  const double n = samples_;
  const double last = n - mi - mj;
  const double count = (n - 2.0 * mi + 1.0) * (n - 2.0 * mj + 1.0);
  choose_lags(mi, mj, last, ringing, rules_->of, plan.lag, plan.weight);
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    const double sides = plan.lag[k] == 0.0 ? 1.0 : 2.0;
    const double overlap = std::min(n - mj, n - mi - plan.lag[k]) - mj + 1.0;
    plan.weight[k] *= sides * overlap / count;
  }
  return plan;
}

void HaarCovariance::fill(Pair& plan, std::size_t i, std::size_t j, const Model& model, bool remember_shapes) {
  const std::size_t size = plan.lag.size();
  scratch_.assign(size, 0.0);
  for (const Process& process : model) {
    const ProcessKind& kind = *process.kind;
    if (kind.has_shape() && !remember_shapes) {
      kind.add_haar_cross(process.parameters, half_[i], half_[j], dt_s_, plan.lag, 1.0, scratch_);
      continue;
    }
    std::array<double, kMostShapes> shapes{};
    std::copy(process.parameters.begin() + 1, process.parameters.end(), shapes.begin());
    std::vector<double>& unit = plan.unit[{&kind, shapes}];
    if (unit.empty()) {
      unit.assign(size, 0.0);
      std::vector<double> at_level_one = process.parameters;
      at_level_one[0] = 1.0;
      kind.add_haar_cross(at_level_one, half_[i], half_[j], dt_s_, plan.lag, 1.0, unit);
    }
    const double level = process.parameters[0] * process.parameters[0];
    for (std::size_t k = 0; k < size; ++k) {
      scratch_[k] += level * unit[k];
    }
  }
}

double HaarCovariance::entry(std::size_t i, std::size_t j, const Model& model, bool remember_shapes) {
  Pair& plan = pair(i, j, model);
  fill(plan, i, j, model, remember_shapes);
  double mean_i = 0.0;
  double mean_j = 0.0;
  for (const Process& process : model) {
    mean_i += process.haar_mean(half_[i], dt_s_);
    mean_j += process.haar_mean(half_[j], dt_s_);
  }
  double squares = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    squares += plan.weight[k] * scratch_[k] * scratch_[k];
    sum += plan.weight[k] * scratch_[k];
  }
  // A deterministic curve would have no variance at all; its rounding is some 10^-8 of it.
  const double rounding = i == j ? 1e-16 * std::pow(haar_variance(model, half_[i], dt_s_), 2.0) : 0.0;
  return 2.0 * squares + 4.0 * mean_i * mean_j * sum + rounding;
}

std::array<double, HaarCovariance::kEvenPowers> HaarCovariance::sums_of(const Pair& plan, std::size_t i, std::size_t j,
                                                                        const Model& model) const {
  std::array<double, kEvenPowers> sums{};
  const auto variance = [&](double half) {
    double sum = 0.0;
    for (const Process& process : model) {
      if (process.haar_mean(half, dt_s_) == 0.0) {
        sum += process.haar_variance(half, dt_s_);
      }
    }
    return sum;
  };
  const double scale = std::sqrt(variance(half_[i]) * variance(half_[j]));
  if (!(scale > 0.0)) {
    return sums;
  }
  for (std::size_t k = 0; k < plan.lag.size(); ++k) {
    const double rho = scratch_[k] / scale;
    double power = plan.weight[k];
    for (double& sum : sums) {
      power *= rho * rho;
      sum += power;
    }
  }
  return sums;
}

std::array<double, HaarCovariance::kEvenPowers> HaarCovariance::correlation_sums(std::size_t i, std::size_t j,
                                                                                 const Model& model) {
  Pair& plan = pair(i, j, model);
  fill(plan, i, j, model, true);
  return sums_of(plan, i, j, model);
}

std::array<double, HaarCovariance::kEvenPowers> HaarCovariance::thinned_sums(std::size_t j, std::size_t stride,
                                                                             const Model& model) {
  Pair& plan = thinned_[j];
  if (stride_[j] != stride) {
    plan = {};
    stride_[j] = stride;
    const double count = samples_ - 2.0 * half_[j] + 1.0;
    const auto step = static_cast<double>(stride);
    for (double lag = 0.0; lag <= 4.0 * half_[j] && lag < count; lag += step) {
      plan.lag.push_back(lag);
      plan.weight.push_back((lag == 0.0 ? 1.0 : 2.0) * step * (count - lag) / (count * count));
    }
  }
  fill(plan, j, j, model, true);
  return sums_of(plan, j, j, model);
}

Eigen::MatrixXd HaarCovariance::matrix(const Model& model) {
  const auto scales = static_cast<Eigen::Index>(half_.size());
  Eigen::MatrixXd covariance(scales, scales);
  for (Eigen::Index j = 0; j < scales; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      covariance(i, j) = entry(static_cast<std::size_t>(i), static_cast<std::size_t>(j), model, false);
      covariance(j, i) = covariance(i, j);
    }
  }
  return covariance;
}

Eigen::VectorXd HaarCovariance::diagonal(const Model& model) {
  const auto scales = static_cast<Eigen::Index>(half_.size());
  Eigen::VectorXd variances(scales);
  for (Eigen::Index j = 0; j < scales; ++j) {
    variances(j) = entry(static_cast<std::size_t>(j), static_cast<std::size_t>(j), model, true);
  }
  return variances;
}

}  // namespace driftlab
