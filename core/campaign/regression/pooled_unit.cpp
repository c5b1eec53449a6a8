#include "core/campaign/regression/pooled_unit.hpp"

#include "core/campaign/replicates.hpp"
#include "core/fit/candidate_set.hpp"
#include "core/fit/curve_covariance.hpp"
#include "core/process/distributions.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kSameTau = 1e-3;

/// One recording's curve on the rows of the unit.
struct Curve {
  WaveletRecord record;             ///< [SI]
  std::vector<std::size_t> rows;    ///< of the unit, one per scale that has one
  std::vector<std::size_t> scales;  ///< of the record, as many
  std::vector<double> edf;          ///< as stored, one per scale of the record
  const ReportedChannel* channel = nullptr;
};

struct Grid {
  double dt_s = 0.0;  ///< of the coarsest recording
  std::size_t rows = 0;
  [[nodiscard]] double tau_s(std::size_t row) const { return std::ldexp(dt_s, static_cast<int>(row)); }
};

std::optional<Curve> curve_of(const ReportedChannel& channel, bool robust) {
  Curve curve;
  curve.record = robust ? record_of(channel, true) : record_of(channel);
  curve.channel = &channel;
  const std::size_t scales = curve.record.half.size();
  if (scales < 2 || curve.record.variance.size() != scales || !(curve.record.dt_s > 0.0) ||
      2 * curve.record.half.back() > curve.record.samples) {
    return std::nullopt;
  }
  curve.edf = channel.haar.edf;
  curve.edf.resize(scales, 0.0);
  return curve;
}

void place_on(const Grid& grid, Curve& curve) {
  for (std::size_t j = 0; j < curve.record.half.size(); ++j) {
    const double octave = std::log2(static_cast<double>(curve.record.half[j]) * curve.record.dt_s / grid.dt_s);
    const double row = std::round(octave);
    if (row < 0.0 || row >= static_cast<double>(grid.rows) || !(curve.record.variance[j] > 0.0)) {
      continue;
    }
    const auto at = static_cast<std::size_t>(row);
    if (!curve.rows.empty() && curve.rows.back() == at) {
      continue;
    }
    curve.rows.push_back(at);
    curve.scales.push_back(j);
  }
}

/// What the pooled curve says of the noise, in units whose largest variance is 1.
struct Pool {
  Model mixture;
  double unit_square = 1.0;
  HaarVariance curve;  ///< on the rows that have one
  NoiseShape shape;
};

double mixture_at(const Pool& pool, double tau_s, double dt_s) {
  return haar_variance(pool.mixture, tau_s / dt_s, dt_s);
}

/// Weighted mean of the compared recordings' variances; weights: stored degrees of freedom.
HaarVariance mean_curve(const Grid& grid, const std::vector<std::vector<Curve>>& sessions, std::size_t compared) {
  std::vector<double> sum(grid.rows, 0.0);
  std::vector<double> weight(grid.rows, 0.0);
  HaarVariance mean;
  for (std::size_t s = 0; s < compared; ++s) {
    for (const Curve& curve : sessions[s]) {
      mean.samples = std::max(mean.samples, static_cast<std::size_t>(static_cast<double>(curve.record.samples) *
                                                                     curve.record.dt_s / grid.dt_s));
      for (std::size_t i = 0; i < curve.rows.size(); ++i) {
        const double edf = std::max(curve.edf[curve.scales[i]], 0.5);
        sum[curve.rows[i]] += edf * curve.record.variance[curve.scales[i]];
        weight[curve.rows[i]] += edf;
      }
    }
  }
  for (std::size_t row = 0; row < grid.rows && weight[row] > 0.0; ++row) {
    const std::size_t half = std::size_t{1} << row;
    if (2 * half > mean.samples) {
      break;
    }
    mean.half.push_back(half);
    mean.variance.push_back(sum[row] / weight[row]);
  }
  return mean;
}

/// Covariances under the mixture, one plan per length and interval.
class Plans {
 public:
  explicit Plans(const Pool& pool) : pool_(pool) {}

  /// Covariance of the variances of a complete record [unit of the pool], and what the mixture gives for them.
  const std::pair<Eigen::MatrixXd, Eigen::VectorXd>& of(const WaveletRecord& record) {
    const Key key{record.samples, record.dt_s, record.half};
    auto found = known_.find(key);
    if (found == known_.end()) {
      HaarCovariance plan(record.half, record.samples, record.dt_s);
      Eigen::MatrixXd covariance = plan.matrix(pool_.mixture);
      if (pool_.shape.kurtosis != 0.0) {
        add_kurtosis(covariance, pool_.mixture, plan.half(), record.samples, record.dt_s, pool_.shape);
      }
      Eigen::VectorXd described(covariance.rows());
      for (Eigen::Index j = 0; j < described.size(); ++j) {
        described(j) =
            haar_variance(pool_.mixture, static_cast<double>(record.half[static_cast<std::size_t>(j)]), record.dt_s);
      }
      found = known_.emplace(key, std::pair(std::move(covariance), std::move(described))).first;
    }
    return found->second;
  }

 private:
  using Key = std::tuple<std::size_t, double, std::vector<std::size_t>>;
  const Pool& pool_;
  std::map<Key, std::pair<Eigen::MatrixXd, Eigen::VectorXd>> known_;
};

/// The excess kurtosis that the stored degrees of freedom of the first scales tell of: what they are fewer (or more)
/// than those of Gaussian noise with the pooled spectrum, in the mean over the recordings.
NoiseShape shape_of(const Pool& pool, const std::vector<std::vector<Curve>>& sessions, std::size_t compared) {
  Plans gaussian(pool);
  double sum = 0.0;
  double weight = 0.0;
  bool rough = true;
  for (std::size_t s = 0; s < compared; ++s) {
    for (const Curve& curve : sessions[s]) {
      if (curve.channel->contaminated() || !(curve.edf.front() > 0.0)) {
        continue;
      }
      const auto& [covariance, described] = gaussian.of(curve.record);
      const double level = described(0) * described(0);
      const double part =
          part_variance(pool.mixture, static_cast<double>(curve.record.half.front()), curve.record.dt_s, true);
      rough = part >= 0.5 * described(0);
      const double own = rough ? part : described(0) - part;
      const double added = 2.0 / (curve.edf.front() * curve.record.inflation.front()) - covariance(0, 0) / level;
      const double share = kurtosis_share(curve.record.half.front(), curve.record.samples);
      sum += curve.edf.front() * added * level / (own * own * share);
      weight += curve.edf.front();
    }
  }
  const double kurtosis = weight > 0.0 ? std::max(sum / weight, -2.0) : 0.0;
  return {std::isfinite(kurtosis) ? kurtosis : 0.0, rough};
}

SessionCurve merge(const Grid& grid, const Pool& pool, Plans& plans, const std::vector<Curve>& curves) {
  const auto rows = static_cast<Eigen::Index>(grid.rows);
  SessionCurve merged{Eigen::VectorXd::Zero(rows), Eigen::VectorXd::Zero(rows), Eigen::MatrixXd::Zero(rows, rows)};
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(rows);
  for (const Curve& curve : curves) {
    const auto& [complete, described] = plans.of(curve.record);
    Eigen::VectorXd raise(described.size());
    for (Eigen::Index j = 0; j < raise.size(); ++j) {
      raise(j) = std::sqrt(curve.record.inflation[static_cast<std::size_t>(j)]);
    }
    const CurveCovariance own =
        curve_covariance(described, described, Eigen::MatrixXd(raise.asDiagonal() * complete * raise.asDiagonal()));
    for (std::size_t i = 0; i < curve.rows.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(curve.rows[i]);
      const auto scale = static_cast<Eigen::Index>(curve.scales[i]);
      const double tau_s = static_cast<double>(curve.record.half[curve.scales[i]]) * curve.record.dt_s;
      double value = curve.record.variance[curve.scales[i]];
      if (std::abs(tau_s / grid.tau_s(curve.rows[i]) - 1.0) > kSameTau) {
        value *= mixture_at(pool, grid.tau_s(curve.rows[i]), curve.record.dt_s) / described(scale);
      }
      variance(row) += own.edf(scale) * value;
      merged.edf(row) += own.edf(scale);
      for (std::size_t k = 0; k < curve.rows.size(); ++k) {
        merged.sampling(row, static_cast<Eigen::Index>(curve.rows[k])) +=
            own.edf(scale) * own.edf(static_cast<Eigen::Index>(curve.scales[k])) *
            own.covariance.whole()(scale, static_cast<Eigen::Index>(curve.scales[k]));
      }
    }
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (const double edf = merged.edf(row); edf > 0.0) {
      merged.x(row) = 0.5 * (std::log(variance(row) / edf) - digamma(0.5 * edf) + std::log(0.5 * edf));
      merged.sampling.row(row) /= 2.0 * edf;
      merged.sampling.col(row) /= 2.0 * edf;
    } else {
      merged.sampling(row, row) = 1.0;
    }
  }
  return merged;
}

/// The model with the least sum of criteria among those that every recording was fitted with.
std::string best_model(const std::vector<std::vector<Curve>>& sessions, std::size_t compared) {
  std::map<std::string, std::pair<double, std::size_t>> sums;
  std::size_t recordings = 0;
  for (std::size_t s = 0; s < compared; ++s) {
    for (const Curve& curve : sessions[s]) {
      ++recordings;
      for (const ReportedFit& fit : curve.channel->fits) {
        auto& [sum, count] = sums[fit.model];
        sum += fit.wic;
        ++count;
      }
    }
  }
  std::string best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [model, of] : sums) {
    if (of.second == recordings && of.first < least) {
      best = model;
      least = of.first;
    }
  }
  return best;
}

void fit_levels(const Grid& grid, const Pool& pool, const std::string& model, PooledUnit& unit) {
  const auto structure = parse_model(model);
  if (!structure || pool.curve.half.size() <= structure->parameter_count()) {
    return;
  }
  HaarCovariance plan(pool.curve.half, pool.curve.samples, grid.dt_s);
  const VarianceIntervals intervals = variance_intervals(pool.curve, plan);
  WaveletMoments moments;
  moments.nu = Eigen::Map<const Eigen::VectorXd>(pool.curve.variance.data(),
                                                 static_cast<Eigen::Index>(pool.curve.variance.size()));
  moments.half.assign(plan.half().begin(), plan.half().end());
  moments.samples = static_cast<double>(pool.curve.samples);
  moments.dt_s = grid.dt_s;
  const Candidate fitted = fit_alone(moments, *structure, intervals.estimate_variance.cwiseSqrt(),
                                     curve_covariance(moments.nu, intervals.modelled, plan.matrix(intervals.mixture)));
  const Model active = fitted.log_fit != nullptr ? fitted.log_fit->model_at(fitted.log_fit->best()) : Model{};
  if (active.empty()) {
    return;
  }
  const auto rows = static_cast<Eigen::Index>(grid.rows);
  unit.model = model;
  unit.modelled.resize(rows);
  unit.sensitivity.resize(rows, static_cast<Eigen::Index>(active.size()));
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double half = std::ldexp(1.0, static_cast<int>(row));
    const double total = haar_variance(active, half, grid.dt_s);
    unit.modelled(row) = 0.5 * std::log(total * pool.unit_square);
    for (std::size_t p = 0; p < active.size(); ++p) {
      unit.sensitivity(row, static_cast<Eigen::Index>(p)) = active[p].haar_variance(half, grid.dt_s) / total;
    }
  }
  for (const Process& process : active) {
    unit.levels.push_back({std::string(process.kind->name), std::string(process.kind->parameters[0].name), 0.0, false});
    unit.shapes += process.kind->parameters.size() - 1;
  }
}

/// Gross errors in one of the arms: all sessions are then compared by one estimator.
bool ask_for_robust(const std::vector<SessionChannels>& sessions, std::size_t compared) {
  return std::any_of(sessions.begin(), sessions.begin() + static_cast<std::ptrdiff_t>(compared),
                     [](const SessionChannels& session) {
                       return std::any_of(session.begin(), session.end(), [](const ReportedChannel* channel) {
                         return channel->contaminated() && !channel->haar.robust_variance.empty();
                       });
                     });
}

}  // namespace

std::optional<PooledUnit> pool_unit(const std::vector<SessionChannels>& sessions, std::size_t compared,
                                    const std::stop_token& stop) {
  std::vector<std::vector<Curve>> curves(sessions.size());
  Grid grid;
  const bool robust = ask_for_robust(sessions, compared);
  double longest_s = 0.0;
  double finest = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    for (const ReportedChannel* channel : sessions[s]) {
      if (auto curve = curve_of(*channel, robust)) {
        if (s < compared) {
          grid.dt_s = std::max(grid.dt_s, curve->record.dt_s);
          finest = std::min(finest, curve->record.dt_s);
          longest_s = std::max(longest_s, static_cast<double>(curve->record.half.back()) * curve->record.dt_s);
        }
        curves[s].push_back(std::move(*curve));
      }
    }
  }
  if (!(grid.dt_s > 0.0)) {
    return std::nullopt;
  }
  grid.rows = static_cast<std::size_t>(std::floor(std::log2(longest_s / grid.dt_s) + 0.5)) + 1;
  for (std::vector<Curve>& session : curves) {
    for (Curve& curve : session) {
      place_on(grid, curve);
    }
  }
  Pool pool;
  pool.curve = mean_curve(grid, curves, compared);
  if (pool.curve.half.size() < 2) {
    return std::nullopt;
  }
  grid.rows = pool.curve.half.size();
  for (std::vector<Curve>& session : curves) {
    for (Curve& curve : session) {
      while (!curve.rows.empty() && curve.rows.back() >= grid.rows) {
        curve.rows.pop_back();
        curve.scales.pop_back();
      }
    }
  }
  pool.unit_square = *std::max_element(pool.curve.variance.begin(), pool.curve.variance.end());
  for (double& variance : pool.curve.variance) {
    variance /= pool.unit_square;
  }
  HaarCovariance plan(pool.curve.half, pool.curve.samples, grid.dt_s);
  pool.mixture = variance_intervals(pool.curve, plan).mixture;
  pool.shape = robust ? NoiseShape{} : shape_of(pool, curves, compared);
  PooledUnit unit;
  unit.robust = robust;
  unit.mixed_rates = grid.dt_s / finest > 1.0 + kSameTau;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    unit.tau_s.push_back(grid.tau_s(row));
  }
  Plans plans(pool);
  for (const std::vector<Curve>& session : curves) {
    if (stop.stop_requested()) {
      return std::nullopt;
    }
    unit.sessions.push_back(merge(grid, pool, plans, session));
  }
  fit_levels(grid, pool, best_model(curves, compared), unit);
  return unit;
}

}  // namespace driftlab::regression
