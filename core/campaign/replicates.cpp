#include "core/campaign/replicates.hpp"

#include "core/process/distributions.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab {
namespace {

/// Recordings of one length and interval share the lag sums of their covariance.
struct SharedPlan {
  std::vector<std::size_t> half;
  std::size_t samples = 0;
  HaarCovariance covariance;
};

/// One recording in the stack.
struct Block {
  std::size_t plan = 0;
  std::vector<Eigen::Index> scales;  ///< of the plan, those with a positive variance
  Eigen::VectorXd root_inflation;    ///< per row
  WaveletMoments moments;            ///< its own rows, in the unit of the stack
  Eigen::MatrixXd covariance;        ///< of its rows, under the mixture that describes them
  Eigen::VectorXd described;         ///< variances of that mixture
  double discrepancy = 0.0;
  Eigen::Index first = 0;  ///< of its rows in the stack
};

Status check(const WaveletRecord& record) {
  const bool shaped = record.half.size() == record.variance.size() &&
                      (record.inflation.empty() || record.inflation.size() == record.half.size()) &&
                      record.dt_s > 0.0 && std::is_sorted(record.half.begin(), record.half.end());
  if (!shaped || record.half.empty() || 2 * record.half.back() > record.samples) {
    return fail(ErrorCode::InvalidArgument, "A recording's wavelet variances do not have the shape they state.");
  }
  if (std::count_if(record.variance.begin(), record.variance.end(), [](double v) { return v > 0.0; }) < 2) {
    return fail(ErrorCode::TooFewSamples, "A recording has fewer than two wavelet variances that are not zero.");
  }
  return {};
}

void withdraw(FittedProcess& process, const char* reason) {
  for (FittedParameter& parameter : process.parameters) {
    parameter.estimate.reset();
    parameter.reason = reason;
    parameter.upper_limit = std::numeric_limits<double>::infinity();
  }
}

/// Takes back what a fit cannot say: where one of several processes of a kind vanished, or changes so fast that it is
/// white noise under another name, the curve does not tell which of them the others are.
void withdraw_ambiguous(const Model& model, double dt_s, ModelFit& fit) {
  for (std::size_t p = 0; p < model.size(); ++p) {
    const bool repeated = std::count_if(model.begin(), model.end(),
                                        [&](const Process& other) { return other.kind == model[p].kind; }) > 1;
    if (!repeated || model[p].kind->symbol != "GM") {
      continue;
    }
    const bool ambiguous = std::any_of(model.begin(), model.end(), [&](const Process& other) {
      return other.kind == model[p].kind && (!(other.parameters[0] > 0.0) || other.parameters[1] * dt_s > 1.0);
    });
    if (ambiguous) {
      withdraw(
          fit.processes[p],
          "Not identifiable: one of the alike processes vanished or is white noise under another name, and the data "
          "do not tell which the other is.");
    }
  }
}

}  // namespace

WaveletRecord record_of(const ReportedChannel& channel) { return record_of(channel, channel.contaminated()); }

WaveletRecord record_of(const ReportedChannel& channel, bool robust) {
  const double factor = channel.parsed_unit().factor;
  WaveletRecord record;
  record.samples = channel.samples + channel.missing;
  record.dt_s = channel.dt_s;
  record.discrepancy = channel.discrepancy;
  record.from_tau_s = channel.from_tau_s;
  const ReportedHaar& haar = channel.haar;
  const std::size_t scales = haar.variance.size();
  const bool wanted = robust && haar.robust_variance.size() == scales;
  for (std::size_t j = 0; j < haar.scale.size(); ++j) {
    const bool own = wanted && j < scales && (haar.robust_variance[j] > 0.0 || channel.contaminated());
    const std::vector<double>& efficiencies = own ? haar.robust_efficiency : haar.efficiency;
    const double efficiency = j < efficiencies.size() ? efficiencies[j] : 1.0;
    record.half.push_back(haar.scale[j] / 2);
    record.inflation.push_back(efficiency > 0.0 ? 1.0 / efficiency : 1.0);
    if (j < scales) {
      record.variance.push_back((own ? haar.robust_variance[j] : haar.variance[j]) * factor * factor);
    }
  }
  return record;
}

struct Replicates::Blocks {
  std::vector<SharedPlan> plans;
  std::vector<Block> blocks;
  WaveletMoments moments;
  Eigen::VectorXd sd;
  double samples = 0.0;
  double unit = 1.0;
  std::shared_ptr<const WhitenedCurve> exact;      ///< at discrepancy 0
  std::shared_ptr<const WhitenedCurve> forgiving;  ///< with the discrepancies of the recordings

  std::size_t plan_for(const WaveletRecord& record) {
    const auto found = std::find_if(plans.begin(), plans.end(), [&](const SharedPlan& plan) {
      return plan.samples == record.samples && plan.half == record.half && plan.covariance.dt_s() == record.dt_s;
    });
    if (found == plans.end()) {
      plans.push_back({record.half, record.samples, HaarCovariance(record.half, record.samples, record.dt_s)});
      return plans.size() - 1;
    }
    return static_cast<std::size_t>(found - plans.begin());
  }

  void add(const WaveletRecord& record) {
    Block block;
    block.plan = plan_for(record);
    block.first = moments.nu.size();
    for (std::size_t j = 0; j < record.half.size(); ++j) {
      const double tau_s = static_cast<double>(record.half[j]) * record.dt_s;
      if (record.variance[j] > 0.0 && tau_s >= record.from_tau_s * (1.0 - 1e-9)) {
        block.scales.push_back(static_cast<Eigen::Index>(j));
        block.moments.half.push_back(static_cast<double>(record.half[j]));
      }
    }
    const auto rows = static_cast<Eigen::Index>(block.scales.size());
    block.moments.nu.resize(rows);
    block.root_inflation.setOnes(rows);
    HaarVariance curve{record.samples, record.half, record.variance};
    for (double& variance : curve.variance) {
      variance = std::max(0.0, variance / (unit * unit));
    }
    HaarCovariance& plan = plans[block.plan].covariance;
    const VarianceIntervals intervals = variance_intervals(curve, plan);
    const Eigen::MatrixXd whole = plan.matrix(intervals.mixture);
    block.described.resize(rows);
    block.discrepancy = record.discrepancy;
    sd.conservativeResize(block.first + rows);
    moments.nu.conservativeResize(block.first + rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const auto j = static_cast<std::size_t>(block.scales[static_cast<std::size_t>(row)]);
      block.moments.nu(row) = curve.variance[j];
      if (!record.inflation.empty()) {
        block.root_inflation(row) = std::sqrt(record.inflation[j]);
      }
      sd(block.first + row) =
          std::sqrt(intervals.estimate_variance(static_cast<Eigen::Index>(j))) * block.root_inflation(row);
      block.described(row) = intervals.modelled(static_cast<Eigen::Index>(j));
    }
    block.covariance =
        block.root_inflation.asDiagonal() * whole(block.scales, block.scales) * block.root_inflation.asDiagonal();
    block.moments.samples = static_cast<double>(record.samples);
    block.moments.dt_s = record.dt_s;
    moments.nu.tail(rows) = block.moments.nu;
    std::size_t like = moments.half.size();
    for (const Block& before : blocks) {
      if (before.moments.dt_s == record.dt_s && before.moments.half == block.moments.half) {
        like = static_cast<std::size_t>(before.first);
        break;
      }
    }
    moments.stretches.push_back({moments.half.size(), block.moments.half.size(), like});
    moments.half.insert(moments.half.end(), block.moments.half.begin(), block.moments.half.end());
    moments.row_dt_s.insert(moments.row_dt_s.end(), static_cast<std::size_t>(rows), record.dt_s);
    const bool first = blocks.empty();
    moments.dt_s = first ? record.dt_s : std::min(moments.dt_s, record.dt_s);
    moments.samples = std::max(moments.samples, block.moments.samples);
    samples += block.moments.samples;
    blocks.push_back(std::move(block));
  }

  /// The stack as one curve.
  [[nodiscard]] CurveCovariance curve() const {
    std::vector<Eigen::MatrixXd> covariance;
    Eigen::VectorXd described(moments.nu.size());
    for (const Block& block : blocks) {
      covariance.push_back(block.covariance);
      described.segment(block.first, block.moments.nu.size()) = block.described;
    }
    return curve_covariance(moments.nu, described, BlockDiagonal(std::move(covariance)));
  }

  /// Covariance of the stacked variances under one model of all.
  BlockDiagonal covariance(const Model& model) {
    std::vector<Eigen::MatrixXd> by_plan;
    by_plan.reserve(plans.size());
    for (SharedPlan& plan : plans) {
      by_plan.push_back(plan.covariance.matrix(model));
    }
    std::vector<Eigen::MatrixXd> stacked;
    for (const Block& block : blocks) {
      stacked.emplace_back(block.root_inflation.asDiagonal() * by_plan[block.plan](block.scales, block.scales) *
                           block.root_inflation.asDiagonal());
    }
    return BlockDiagonal(std::move(stacked));
  }

  [[nodiscard]] Eigen::VectorXd discrepancies() const {
    Eigen::VectorXd delta(moments.nu.size());
    for (const Block& block : blocks) {
      delta.segment(block.first, block.moments.nu.size()).setConstant(block.discrepancy);
    }
    return delta;
  }

  void measure() {
    exact = std::make_shared<const WhitenedCurve>(whitened(curve(), 0.0));
    const Eigen::VectorXd delta = discrepancies();
    forgiving = delta.maxCoeff() > 0.0 ? std::make_shared<const WhitenedCurve>(whitened(curve(), delta)) : exact;
  }
};

Replicates::Replicates(std::unique_ptr<Blocks> blocks) : blocks_(std::move(blocks)) {}
Replicates::Replicates(Replicates&&) noexcept = default;
Replicates& Replicates::operator=(Replicates&&) noexcept = default;
Replicates::~Replicates() = default;

Result<Replicates> Replicates::stack(const std::vector<WaveletRecord>& records) {
  if (records.empty()) {
    return fail(ErrorCode::InvalidArgument, "A joint fit needs at least one recording.");
  }
  auto blocks = std::make_unique<Blocks>();
  double largest = 0.0;
  for (const WaveletRecord& record : records) {
    if (auto checked = check(record); !checked) {
      return fail(checked.error());
    }
    largest = std::max(largest, *std::max_element(record.variance.begin(), record.variance.end()));
  }
  blocks->unit = std::sqrt(largest);
  for (const WaveletRecord& record : records) {
    blocks->add(record);
  }
  blocks->measure();
  return Replicates(std::move(blocks));
}

std::size_t Replicates::count() const { return blocks_->blocks.size(); }
std::size_t Replicates::rows() const { return static_cast<std::size_t>(blocks_->moments.nu.size()); }
double Replicates::samples() const { return blocks_->samples; }
double Replicates::unit() const { return blocks_->unit; }

Candidate Replicates::fit(const ModelStructure& structure) {
  Candidate candidate = fit_candidate(blocks_->moments, structure, blocks_->sd, blocks_->exact);
  if (!candidate.log_fit) {
    return candidate;
  }
  if (blocks_->exact != blocks_->forgiving) {
    return refit_candidate(blocks_->moments, candidate, blocks_->forgiving);
  }
  candidate.own_distance =
      distance_under_own(blocks_->moments, candidate, [&](const Model& model) { return blocks_->covariance(model); });
  return candidate;
}

std::optional<Agreement> Replicates::agreement(const Candidate& joint) const {
  if (count() < 2 || joint.log_fit == nullptr) {
    return std::nullopt;
  }
  const Model active = joint.fit.active();
  ModelStructure structure;
  for (const Process& process : active) {
    structure.kinds.push_back(process.kind);
  }
  double separate = 0.0;
  for (const Block& block : blocks_->blocks) {
    const auto curve = std::make_shared<const WhitenedCurve>(
        whitened(curve_covariance(block.moments.nu, block.described, block.covariance), block.discrepancy));
    LogFit own(block.moments, active, curve);
    own.improve(joint.log_fit->best());
    const GmwmSolution alone = fit_gmwm(block.moments, structure, MomentWeights::from_covariance(block.covariance));
    Eigen::VectorXd start = own.best();
    for (std::size_t k = 0; k < own.coordinates().size(); ++k) {
      const LogCoordinate& c = own.coordinates()[k];
      const double value = alone.model[c.process].parameters[c.parameter];
      const double at = value > 0.0 ? (c.parameter == 0 ? 2.0 : 1.0) * std::log(value) : c.low;
      start(static_cast<Eigen::Index>(k)) = std::clamp(at, c.low, c.high);
    }
    own.improve(start);
    separate += own.minimum();
  }
  Agreement agreement;
  agreement.dof = static_cast<double>((count() - 1) * joint.log_fit->coordinates().size());
  agreement.statistic = std::max(0.0, joint.log_fit->minimum() - separate);
  agreement.p = chi_squared_tail(agreement.statistic, agreement.dof);
  return agreement;
}

ModelFit Replicates::report(Candidate& joint, IntervalMethod method) const {
  ModelFit fit = report_fit(joint, unit(), samples(), method);
  withdraw_ambiguous(joint.fit.model, blocks_->moments.dt_s, fit);
  return fit;
}

}  // namespace driftlab
