#include "core/fit/characterise.hpp"

#include "core/fit/bootstrap.hpp"
#include "core/fit/candidate_set.hpp"
#include "core/fit/channel_variances.hpp"
#include "core/fit/closeness.hpp"
#include "core/fit/curve_description.hpp"
#include "core/fit/fit_report.hpp"
#include "core/fit/model_search.hpp"
#include "core/fit/stationarity.hpp"
#include "core/variance/dynamic_allan.hpp"
#include "core/variance/empirical_scatter.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kFewestSamples = 8;
/// Models whose criterion with 2p is this close to the best cannot be told apart.
constexpr double kPlausible = 6.0;
constexpr int kMostRankings = 5;
/// A tau written in decimals is that of its scale.
constexpr double kRounding = 1e-9;

/// Whether `samples` are one noise, and how their Allan variance moves where that is asked for.
void look_along_time(std::span<const double> samples, const ChannelSamples& channel, std::size_t windows,
                     const RunControl& control, ChannelCharacterisation& result) {
  result.stationarity = test_stationarity(samples, channel.dt_s);
  for (NoiseChange& change : result.stationarity.changes) {
    change.size *= change.kind == NoiseChange::Kind::Jump ? channel.si_factor : 1.0;
  }
  std::vector<std::string> said = describe(result.stationarity, channel.dt_s);
  std::move(said.begin(), said.end(), std::back_inserter(result.warnings));
  if (windows > 0) {
    DynamicAllan moving = dynamic_allan(samples, channel.dt_s, windows, control);
    for (std::vector<double>& row : moving.variance) {
      for (double& variance : row) {
        variance *= channel.si_factor * channel.si_factor;
      }
    }
    result.dynamic_allan = std::move(moving);
  }
}

tl::unexpected<Error> cancelled() { return fail(ErrorCode::Cancelled, "The characterisation was cancelled."); }

Status check_channel(const ChannelSamples& channel) {
  if (!(channel.dt_s > 0.0) || !std::isfinite(channel.dt_s)) {
    return fail(ErrorCode::InvalidArgument, "The sample interval must be a positive number of seconds.",
                {{"parameter", "dt_s"}});
  }
  if (channel.si_factor == 0.0 || !std::isfinite(channel.si_factor)) {
    return fail(ErrorCode::InvalidArgument, "The factor to SI units must be a number other than zero.",
                {{"parameter", "si_factor"}});
  }
  if (channel.values.size() < kFewestSamples) {
    return fail(ErrorCode::TooFewSamples,
                "A channel needs at least " + std::to_string(kFewestSamples) + " samples and has " +
                    std::to_string(channel.values.size()) + ".",
                {{"samples", std::to_string(channel.values.size())}, {"limit", std::to_string(kFewestSamples)}});
  }
  return {};
}

void store_curves(const HaarVariance& curve, const VarianceIntervals* intervals, double square_unit, double dt_s,
                  ChannelCharacterisation& result) {
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    const double variance = curve.variance[j] * square_unit;
    const Interval raw = intervals != nullptr ? intervals->ci95[j] : Interval{0.0, 0.0};
    const Interval interval{raw.low * square_unit, raw.high * square_unit};
    const double edf = intervals != nullptr ? intervals->edf[j] : 0.0;
    result.haar.scale.push_back(2 * curve.half[j]);
    result.haar.variance.push_back(variance);
    result.haar.ci95.push_back(interval);
    result.haar.edf.push_back(edf);
    result.allan.tau_s.push_back(static_cast<double>(curve.half[j]) * dt_s);
    result.allan.variance.push_back(2.0 * variance);
    result.allan.ci95.push_back({2.0 * interval.low, 2.0 * interval.high});
    result.allan.edf.push_back(edf);
  }
}

void store_robust(RobustVariances robust, double si_square, ChannelCharacterisation& result) {
  for (std::size_t j = 0; j < robust.variance.size(); ++j) {
    const auto& value = robust.variance[j];
    result.haar.robust_variance.push_back(value ? std::optional<double>(*value * si_square) : std::nullopt);
    result.haar.robust_ci95.push_back({robust.ci95[j].low * si_square, robust.ci95[j].high * si_square});
    result.haar.robust_efficiency.push_back(robust.efficiency[j]);
  }
  result.haar.robust_sample_wise = robust.sample_wise;
  result.contamination = std::move(robust.contamination);
  std::move(robust.warnings.begin(), robust.warnings.end(), std::back_inserter(result.warnings));
}

void leave_out_coefficients(const char* reason, ChannelCharacterisation& result) {
  AllanParameters& all = result.allan_parameters;
  all.q_reason = all.n_reason = all.b_reason = all.k_reason = all.r_reason = reason;
}

void store_constant(HaarVariance& curve, double dt_s, ChannelCharacterisation& result) {
  std::fill(curve.variance.begin(), curve.variance.end(), 0.0);
  store_curves(curve, nullptr, 0.0, dt_s, result);
  result.warnings.emplace_back("The channel is constant: every variance is zero and no model is fitted.");
  leave_out_coefficients("The channel is constant.", result);
}

/// The models asked for that the number of scales allows, each once; the rest are named in a warning.
std::vector<ModelStructure> structures_of(const WaveletMoments& moments, const CharacteriseOptions& options,
                                          std::vector<std::string>& warnings) {
  std::vector<ModelStructure> structures;
  std::string left_out;
  const auto usable = static_cast<std::size_t>((moments.nu.array() > 0.0).count());
  for (const std::string& model : options.models) {
    ModelStructure structure = *parse_model(model);
    if (structure.parameter_count() > usable) {
      left_out += (left_out.empty() ? "" : ", ") + model_name(structure);
    } else if (std::find(structures.begin(), structures.end(), structure) == structures.end()) {
      structures.push_back(std::move(structure));
    }
  }
  if (!left_out.empty()) {
    warnings.push_back(
        "The record is too short for these models, which have more parameters than it has scales: " + left_out + ".");
  }
  return structures;
}

/// Fits the models, searches for more where asked to, and gives them the discrepancy they need.
Result<CandidateSet> fit_set(const WaveletMoments& moments, const CharacteriseOptions& options,
                             const Eigen::VectorXd& sd, const CurveCovariance& curve,
                             const CovarianceLaw& covariance_of, const RunControl& control,
                             std::vector<std::string>& warnings) {
  const auto part = [&](double from, double share) {
    return control.reporting([&control, from, share](std::string_view stage, double fraction) {
      control.report(stage, from + share * fraction);
    });
  };
  Result<CandidateSet> set =
      fit_candidates(moments, structures_of(moments, options, warnings), sd, curve, part(0.3, 0.4));
  if (!set) {
    return cancelled();
  }
  if (options.search == ModelSearch::Stepwise && !set->candidates.empty() &&
      !search_models(moments, sd, covariance_of, *set, part(0.7, 0.1))) {
    return cancelled();
  }
  if (!forgive(moments, *set, control)) {
    return cancelled();
  }
  return set;
}

void add_equation_8(std::vector<Candidate>& candidates, const WaveletMoments& moments, const Eigen::VectorXd& sd,
                    const Eigen::MatrixXd& covariance) {
  for (Candidate& candidate : candidates) {
    const Equation8 criterion = equation_8(moments, candidate.diagonal, sd, covariance);
    candidate.eq8 = criterion.value();
    candidate.optimism = criterion.optimism;
  }
}

void rank(std::vector<Candidate>& candidates, double samples) {
  std::sort(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const double first = a.criterion(samples);
    const double second = b.criterion(samples);
    if (first != second) {
      return first < second;
    }
    // Equal criteria: the smaller model, then the name, so that the order does not hang on the order asked for.
    const auto key = [](const Candidate& c) {
      return std::pair(c.structure.parameter_count(), model_name(c.structure));
    };
    return key(a) < key(b);
  });
}

/// Ranks the candidates and profiles the best. A profile may come upon a smaller distance than the search did: then the
/// models that contain this one are looked at again, and the ranking is made anew.
ModelFit rank_and_report_best(CandidateSet& set, const WaveletMoments& moments, const CovarianceLaw& covariance_of,
                              double unit) {
  for (int round = 0;; ++round) {
    measure_by_own(moments, set, covariance_of);
    rank(set.candidates, moments.samples);
    Candidate& best = set.candidates.front();
    ModelFit fit = report_fit(best, unit, moments.samples, IntervalMethod::Profile);
    if (round == kMostRankings || !(best.log_fit->minimum() < best.fit.objective)) {
      return fit;
    }
    spread(moments, set, 0);
  }
}

void store_fits(CandidateSet& set, double unit, double samples, ModelFit best_fit, ChannelCharacterisation& result) {
  std::vector<Candidate>& candidates = set.candidates;
  double best = std::numeric_limits<double>::infinity();
  const auto light = [](const Candidate& c) {
    return c.ranked_distance() + 2.0 * static_cast<double>(c.structure.parameter_count());
  };
  for (const Candidate& candidate : candidates) {
    best = std::min(best, light(candidate));
  }
  result.discrepancy = set.curve->delta;
  result.fits.push_back(std::move(best_fit));
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    result.fits.push_back(report_fit(candidates[i], unit, samples, IntervalMethod::Preview));
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    result.fits[i].plausible = light(candidates[i]) <= best + kPlausible;
  }
}

/// Fits, ranks and reports models.
Status fit_models(const FittedVariances& fitted, const CharacteriseOptions& options, double si_unit,
                  HaarCovariance& plan, const RunControl& control, ChannelCharacterisation& result) {
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < plan.half().size(); ++j) {
    if (plan.half()[j] * plan.dt_s() >= options.from_tau_s * (1.0 - kRounding)) {
      rows.push_back(static_cast<Eigen::Index>(j));
    }
  }
  result.from_tau_s = options.from_tau_s;
  if (rows.empty()) {
    result.warnings.emplace_back("No scale of the record is as long as the tau from which models were to be fitted.");
    return {};
  }
  const Eigen::Map<const Eigen::VectorXd> variance(fitted.variance.data(),
                                                   static_cast<Eigen::Index>(fitted.variance.size()));
  WaveletMoments moments{variance(rows), {}, static_cast<double>(plan.samples()), plan.dt_s()};
  for (const Eigen::Index row : rows) {
    moments.half.push_back(plan.half()[static_cast<std::size_t>(row)]);
  }
  const Eigen::VectorXd sd = fitted.sd(rows);
  const CovarianceLaw covariance_of = [&](const Model& model) -> Eigen::MatrixXd {
    return fitted.covariance(plan, model)(rows, rows);
  };
  const Eigen::MatrixXd covariance = covariance_of(fitted.mixture).whole();
  const CurveCovariance curve = curve_covariance(moments.nu, modelled_variance(moments, fitted.mixture), covariance);
  Result<CandidateSet> set = fit_set(moments, options, sd, curve, covariance_of, control, result.warnings);
  if (!set) {
    return fail(std::move(set.error()));
  }
  control.report("parameter intervals", 0.9);
  if (set->candidates.empty()) {
    result.warnings.emplace_back("No model could be fitted.");
    return {};
  }
  add_equation_8(set->candidates, moments, sd, covariance);
  ModelFit best = rank_and_report_best(*set, moments, covariance_of, si_unit);
  if (options.bootstrap != 0) {
    const RunControl part = control.reporting(
        [&](std::string_view stage, double fraction) { control.report(stage, 0.9 + 0.09 * fraction); });
    const Result<std::vector<double>> rises =
        bootstrap_rises(set->candidates.front(), moments, options.bootstrap, options.seed, part);
    if (!rises) {
      return fail(rises.error());
    }
    best = report_fit(set->candidates.front(), si_unit, moments.samples, IntervalMethod::Profile, *rises);
  }
  store_fits(*set, si_unit, moments.samples, std::move(best), result);
  for (ModelFit& fit : result.fits) {
    fit.robust = fitted.robust;
  }
  return {};
}

/// Everything behind the classical variances, which are those of `samples`: the rows, or a series without their gaps.
Status analyse(ClassicalVariances& classical, std::span<const double> samples, const GappySamples& grid, double mean,
               const ChannelSamples& channel, const CharacteriseOptions& options, const RunControl& control,
               ChannelCharacterisation& result) {
  HaarVariance& curve = classical.curve;
  const double largest = classical.unit_square;
  const double si_unit = std::sqrt(largest) * std::fabs(channel.si_factor);
  if (!std::isnormal(si_unit * si_unit) || !std::isnormal(largest)) {
    return fail(ErrorCode::OutOfRange, "The variances of the channel are beyond the range of a double.");
  }
  for (double& variance : curve.variance) {  // everything below in units of the largest deviation
    variance /= largest;
  }
  control.report("intervals", 0.2);
  HaarCovariance plan(curve.half, curve.samples, channel.dt_s);
  const double excess = difference_excess_kurtosis(samples, control);
  VarianceIntervals intervals = variance_intervals(curve, plan, excess);
  // Gross errors have an excess kurtosis that would leave the contamination test no scale of many degrees of freedom:
  // its hypothesis is Gaussian noise, and so are its degrees of freedom.
  VarianceIntervals gaussian = excess == 0.0 ? intervals : variance_intervals(curve, plan);
  lower_degrees(classical.efficiency, curve, intervals);
  lower_degrees(classical.efficiency, curve, gaussian);
  if (classical.efficiency.empty()) {
    const EmpiricalScatter seen = observe_scatter(samples, mean, curve, plan, intervals, control);
    if (seen.departs) {
      result.warnings.push_back(departure_sentence(seen));
    }
  }
  store_curves(curve, &intervals, si_unit * si_unit, channel.dt_s, result);
  result.haar.efficiency = classical.efficiency;
  result.further = further_curves(options.also, samples, mean, largest, channel.si_factor, {intervals, plan}, control);
  control.report("robust variance", 0.25);
  RobustVariances robust = robust_variances(samples, mean, grid, classical, gaussian, plan, options.seed, control);
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  const FittedVariances fitted = fitted_variances(classical, intervals, robust, plan);
  store_robust(std::move(robust), si_unit * si_unit, result);
  control.report("description", 0.28);
  describe_curve({.samples = samples,
                  .mean = mean,
                  .dt_s = channel.dt_s,
                  .unit = std::fabs(channel.si_factor),
                  .unit_square = largest,
                  .half = curve.half,
                  .gaps = !classical.efficiency.empty()},
                 fitted, control, result);
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  return fit_models(fitted, options, si_unit, plan, control, result);
}

/// The longest run of rows between two gaps.
std::span<const double> longest_between_gaps(const ChannelSamples& channel) {
  std::size_t from = 0;
  std::span<const double> longest;
  const auto close = [&](std::size_t to) {
    if (to - from > longest.size()) {
      longest = channel.values.subspan(from, to - from);
    }
    from = to;
  };
  for (const Gap& gap : channel.gaps) {
    close(gap.row);
  }
  close(channel.values.size());
  return longest;
}

/// How close each fit is to the data, which only all of them together say.
void tell_distances(ChannelCharacterisation& channel) {
  std::vector<RankedModel> models;
  models.reserve(channel.fits.size());
  for (const ModelFit& fit : channel.fits) {
    models.push_back({fit.model, fit.wic});
  }
  const std::size_t fitted = fitted_scales(channel.haar.scale, channel.dt_s, channel.from_tau_s);
  const auto distances =
      distances_2p(models, criterion_observations(channel.samples + channel.missing, channel.discrepancy, fitted));
  for (std::size_t i = 0; i < distances.size(); ++i) {
    channel.fits[i].distance_2p = distances[i];
  }
}

Result<ChannelCharacterisation> characterise_as_given(const ChannelSamples& channel, const CharacteriseOptions& options,
                                                      const RunControl& control) {
  control.report("variance", 0.0);
  const Result<SampleSummary> summary = summarise(channel.values, control);
  if (!summary) {
    return summary.error().code == ErrorCode::Cancelled ? cancelled() : fail(summary.error());
  }
  ChannelCharacterisation result;
  result.samples = channel.values.size();
  result.dt_s = channel.dt_s;
  result.mean = summary->mean * channel.si_factor;
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  const Result<GappySamples> grid = channel.gaps.empty() ? GappySamples{} : on_grid(channel.values, channel.gaps);
  if (!grid) {
    return fail(grid.error());
  }
  result.missing = grid->missing_count();
  if (summary->constant()) {
    HaarVariance curve =
        haar_variance(result.missing > 0 ? std::span<const double>(grid->values) : channel.values, 0.0);
    store_constant(curve, channel.dt_s, result);
    control.report("done", 1.0);
    return result;
  }
  Result<ClassicalVariances> classical =
      classical_variances(channel.values, summary->mean, *grid, channel.dt_s, options.seed, control);
  if (!classical) {
    return fail(std::move(classical.error()));
  }
  const std::span<const double> samples =
      result.missing > 0 ? std::span<const double>(classical->completed) : channel.values;
  look_along_time(samples, channel, options.dynamic, control, result);
  Status status = analyse(*classical, samples, *grid, summary->mean, channel, options, control, result);
  if (!status) {
    return fail(std::move(status.error()));
  }
  tell_distances(result);
  control.report("done", 1.0);
  return result;
}

}  // namespace

Result<ChannelCharacterisation> characterise_channel(const ChannelSamples& channel, const CharacteriseOptions& options,
                                                     const RunControl& control) {
  if (Status status = check_options(options); !status) {
    return fail(std::move(status.error()));
  }
  if (Status status = check_channel(channel); !status) {
    return fail(std::move(status.error()));
  }
  Result<ChannelCharacterisation> result = characterise_as_given(channel, options, control);
  const bool untold = !result && result.error().code == ErrorCode::TooFewSamples && !channel.gaps.empty();
  const std::span<const double> rest = untold ? longest_between_gaps(channel) : std::span<const double>();
  if (rest.size() < kFewestSamples) {
    return result;
  }
  Result<ChannelCharacterisation> shorter =
      characterise_as_given({.values = rest, .dt_s = channel.dt_s, .si_factor = channel.si_factor}, options, control);
  if (shorter) {
    shorter->warnings.push_back(
        "The gaps leave too many equal samples to say what is missing in them: only the longest "
        "stretch without a gap is analysed, " +
        std::to_string(rest.size()) + " of " + std::to_string(channel.values.size()) + " samples.");
  }
  return shorter;
}

}  // namespace driftlab
