#include "core/fit/sample_wise_variance.hpp"

#include "core/fit/completion.hpp"
#include "core/fit/gmwm.hpp"
#include "core/fit/outlier_screen.hpp"
#include "core/variance/gappy_variance.hpp"
#include "core/variance/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kFewestRecorded = 16;
constexpr double kMostErrors = 0.2;
constexpr double kSuspect = 5.0;  ///< screen: robust standard deviations
constexpr double kDiscoveryRate = 0.01;
constexpr int kFirstSteps = 100;  ///< of EM
constexpr int kSteps = 40;
constexpr std::size_t kFewestSweeps = 2;
constexpr std::size_t kMostSweeps = 15;
constexpr double kSettled = 0.03;
constexpr double kMostlyWhole = 0.75;
constexpr std::size_t kManySamples = 300000;  ///< from here two draws do for five: the draws differ less than they cost
constexpr double kScattered = 0.25;
constexpr double kIgnored = 1e6;
constexpr std::size_t kFewestScales = 5;
constexpr double kLevelSpread = 1e6;  ///< variance of the unknown level, in squares of the unit

/// Fall of the weighted squared distance that a further process must bring to be believed. Without it, the scatter
/// of the drawn variances is fitted, drawn from and fitted again, and long scales drift up (a fifth, for QN+WN).
constexpr double kEvidence = 10.0;

/// The model that good samples are taken to follow, from their wavelet variances.
class ModelFitter {
 public:
  explicit ModelFitter(HaarCovariance& plan) : plan_(plan), enough_(plan.half().size() >= 6) {
    const auto scales = static_cast<Eigen::Index>(plan.half().size());
    relative_.resize(scales);
    for (Eigen::Index j = 0; j < scales; ++j) {  // before any model: one degree of freedom per filter length or so
      const double length = 2.0 * plan.half()[static_cast<std::size_t>(j)];
      relative_(j) = std::sqrt(2.0 / std::max(0.7, static_cast<double>(plan.samples()) / length));
    }
  }

  /// The fit to the first `scales` variances; empty where no process has a positive level.
  Model fit(const std::vector<double>& variance, std::size_t scales) {
    WaveletMoments moments;
    moments.nu = Eigen::Map<const Eigen::VectorXd>(variance.data(), static_cast<Eigen::Index>(variance.size()));
    moments.half.assign(plan_.half().begin(), plan_.half().end());
    moments.samples = static_cast<double>(plan_.samples());
    moments.dt_s = plan_.dt_s();
    const double floor = 1e-9 * moments.nu.maxCoeff();
    if (!(floor > 0.0)) {
      return {};
    }
    Model model;
    for (int round = 0; round < 2; ++round) {  // relative errors from the model, levels from the data: a poor fit does
                                               // not make its own misfit look small
      double level = 0.0;
      sd_.resize(relative_.size());
      for (Eigen::Index j = 0; j < sd_.size(); ++j) {
        // Where a variance scatters by more than a quarter a small one is chance: no steeper than white noise.
        level = std::max({moments.nu(j), floor, relative_(j) > kScattered ? 0.5 * level : 0.0});
        sd_(j) = relative_(j) * level * (static_cast<std::size_t>(j) < scales ? 1.0 : kIgnored);
      }
      model = best_fit(moments, MomentWeights::from_sd(sd_));
      if (model.empty()) {
        return model;
      }
      relative_ = plan_.diagonal(model).cwiseSqrt().cwiseQuotient(modelled_variance(moments, model));
      relative_ = relative_.cwiseMin(2.0).cwiseMax(1e-6);
    }
    return model;
  }

  [[nodiscard]] const Eigen::VectorXd& sd() const { return sd_; }

 private:
  /// WN+RW, and quantization noise and a Gauss-Markov process where the data insist.
  [[nodiscard]] Model best_fit(const WaveletMoments& moments, const MomentWeights& weights) const {
    GmwmSolution best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < structures_.size() && (k < 1 || enough_); ++k) {
      GmwmSolution found = fit_gmwm(moments, structures_[k], weights);
      const double extra = static_cast<double>(structures_[k].kinds.size()) - 2.0;
      const bool good_enough = found.objective < kEvidence;
      if (found.objective + kEvidence * extra < least) {
        least = found.objective + kEvidence * extra;
        best = std::move(found);
      }
      if (good_enough) {
        break;
      }
    }
    return best.active();
  }

  HaarCovariance& plan_;
  bool enough_;  ///< scales for more than white noise and a random walk
  std::array<ModelStructure, 4> structures_{*parse_model("WN+RW"), *parse_model("QN+WN+RW"), *parse_model("WN+GM+RW"),
                                            *parse_model("QN+WN+GM+RW")};
  Eigen::VectorXd relative_;
  Eigen::VectorXd sd_;  ///< of the wavelet variances under the last fit
};

/// The record in units of its robust spread around a level near its median, and the present state of every sample.
struct Work {
  double unit = 1.0;
  double pivot = 0.0;
  std::vector<double> recorded;
  std::vector<std::uint8_t> state;
  std::vector<std::uint8_t> patch;
  std::vector<std::uint8_t> absent;  ///< 1: a gap of the record
  OutlierMixture mixture;            ///< relative to the square of the unit
  bool patched = false;
};

/// Size of the mixture that an error of `magnitude` standard deviations most looks like.
std::uint8_t size_state(const OutlierMixture& mixture, double magnitude) {
  std::size_t k = 0;
  while (k + 1 < mixture.ratio.size() && mixture.ratio[k] < magnitude * magnitude) {
    ++k;
  }
  return static_cast<std::uint8_t>(k + 1);
}

/// About the median of the recorded samples.
double rough_median(std::span<const double> recorded) {
  constexpr std::size_t kLooks = 65536;
  const std::size_t stride = std::max<std::size_t>(1, recorded.size() / kLooks);
  std::vector<double> few;
  few.reserve(recorded.size() / stride + 1);
  for (std::size_t i = 0; i < recorded.size(); i += stride) {
    few.push_back(recorded[i]);
  }
  const auto middle = few.begin() + static_cast<std::ptrdiff_t>(few.size() / 2);
  std::nth_element(few.begin(), middle, few.end());
  return *middle;
}

/// Screens the record; false if it has no spread.
bool prepare(const GappySamples& samples, bool look, Work& work, const RunControl& control) {
  std::vector<double> packed;
  if (!samples.missing.empty()) {
    packed.reserve(samples.size());
    for (std::size_t t = 0; t < samples.size(); ++t) {
      if (!samples.is_missing(t)) {
        packed.push_back(samples.values[t]);
      }
    }
  }
  const std::span<const double> there = samples.missing.empty() ? std::span(samples.values) : std::span(packed);
  const OutlierScreen screen = screen_outliers(there, control);
  if (!(screen.sd > 0.0) || !std::isfinite(1.0 / screen.sd)) {
    return false;
  }
  work.unit = screen.sd;
  work.pivot = rough_median(there);
  work.recorded.assign(samples.size(), 0.0);
  work.state.assign(samples.size(), kAbsentSample);
  work.patch.assign(samples.size(), 0);
  work.absent.assign(samples.size(), 1);
  if (look) {
    ResidualHistogram histogram;
    for (const float residual : screen.residual) {
      histogram.add(std::fabs(static_cast<double>(residual)));
    }
    work.mixture = OutlierMixture::up_to(histogram.largest());
    work.mixture.refine(histogram, kFirstSteps);
  }
  std::size_t i = 0;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    if (samples.is_missing(t)) {
      continue;
    }
    work.recorded[t] = (there[i] - work.pivot) / work.unit;
    work.state[t] = kGoodSample;
    work.absent[t] = 0;
    const double magnitude = std::fabs(static_cast<double>(screen.residual[i]));
    if (look && screen.patch[i] != 0) {
      work.state[t] = kAbsentSample;
      work.patch[t] = 1;
      work.patched = true;
    } else if (look && magnitude > kSuspect) {
      work.state[t] = size_state(work.mixture, magnitude);
    }
    ++i;
  }
  return true;
}

/// Wavelet variances to start from: of whole windows without suspects, up to the scale where they become too few; with
/// fewer than kFewestScales such scales, of the series with suspects and gaps closed up.
std::vector<double> first_variances(const Work& work, const HaarCovariance& plan, std::size_t& scales,
                                    const RunControl& control) {
  GappySamples good{work.recorded, std::vector<std::uint8_t>(work.state.size())};
  std::vector<double> closed;
  closed.reserve(work.state.size());
  for (std::size_t t = 0; t < good.missing.size(); ++t) {
    good.missing[t] = work.state[t] == kGoodSample ? 0 : 1;
    if (good.missing[t] == 0) {
      closed.push_back(work.recorded[t]);
    }
  }
  std::vector<double> variance = haar_variance(closed, 0.0, control).variance;
  variance.resize(plan.half().size(), variance.empty() ? 0.0 : variance.back());
  scales = variance.size();
  if (closed.size() == good.size()) {
    return variance;
  }
  const WholeWindowScan scan(good);
  std::vector<std::size_t> half;
  for (std::size_t j = 0; j < variance.size(); ++j) {
    const auto m = static_cast<std::size_t>(plan.half()[j]);
    const std::size_t windows = scan.windows(m);
    if (windows < 50 || static_cast<double>(windows) / static_cast<double>(good.size() - 2 * m + 1) < 0.1) {
      scales = j >= kFewestScales ? j : scales;
      break;
    }
    half.push_back(m);
  }
  const std::vector<std::optional<WholeWindows>> whole = scan.at(half, control);
  for (std::size_t j = 0; j < half.size(); ++j) {
    variance[j] = whole[j] ? whole[j]->variance : variance[j];
  }
  return variance;
}

/// Wavelet variances of several draws.
class DrawnCurves {
 public:
  void add(const HaarVariance& curve) {
    mean_.resize(curve.scales(), 0.0);
    square_.resize(curve.scales(), 0.0);
    count_ += 1.0;
    for (std::size_t j = 0; j < curve.scales(); ++j) {  // Welford's running mean and sum of squares
      const double step = curve.variance[j] - mean_[j];
      mean_[j] += step / count_;
      square_[j] += step * (curve.variance[j] - mean_[j]);
    }
  }
  [[nodiscard]] const std::vector<double>& mean() const { return mean_; }
  /// Var of the estimate on a whole series, `own`, over that of the mean of the draws.
  [[nodiscard]] double efficiency(std::size_t j, double own) const {
    const double between = count_ > 1.0 ? square_[j] / (count_ - 1.0) : 0.0;
    return own > 0.0 ? own / (own + (1.0 + 1.0 / count_) * between) : 1.0;
  }

 private:
  std::vector<double> mean_;
  std::vector<double> square_;
  double count_ = 0.0;
};

/// Sweeps, fits and what they leave.
class Sampler {
 public:
  Sampler(Work work, HaarCovariance& plan, std::uint64_t seed, const RunControl& control)
      : work_(std::move(work)),
        plan_(plan),
        control_(control),
        fitter_(plan),
        random_(seed),
        completed_(work_.state.size()),
        residual_(work_.state.size()) {
    law_.mixture = std::move(work_.mixture);
    std::size_t scales = 0;
    const std::vector<double> variance = first_variances(work_, plan, scales, control);
    if (!control.stop.stop_requested()) {
      model_ = fitter_.fit(variance, scales);
    }
  }

  /// One sweep, new shares and a new fit. Nothing where the model has no states (a degenerate record), or the token
  /// asked.
  std::optional<HaarVariance> sweep() {
    const auto states = linear_states(model_, plan_.dt_s(), kLevelSpread);
    if (!states) {
      return std::nullopt;
    }
    law_.states = *states;
    // The mixture is measured in residuals of the last model. Before the first it is in those of the screen, whose
    // core and sizes are taken as shares of its spread.
    const double unit = states->leave_one_out_variance();
    const double factor = started_ ? law_.unit / unit : 1.0;
    step_ = std::log(factor);
    started_ = true;
    law_.mixture.core *= factor;
    for (double& ratio : law_.mixture.ratio) {
      ratio *= factor;
    }
    law_.unit = unit;
    histogram_.clear();
    sweep_completion(law_, {work_.recorded, work_.state, completed_, residual_}, random_, histogram_, control_);
    law_.mixture.refine(histogram_, kSteps);
    const Result<SampleSummary> summary = summarise(completed_, control_);
    if (!summary) {
      return std::nullopt;
    }
    HaarVariance curve = haar_variance(completed_, summary->mean, control_);
    if (control_.stop.stop_requested()) {
      return std::nullopt;
    }
    model_ = fitter_.fit(curve.variance, curve.scales());
    return curve;
  }

  /// Whether `sweep` (from 0) may be a draw: the residual variance has stopped moving.
  [[nodiscard]] bool settled(std::size_t sweep) const {
    return sweep >= kMostSweeps || (sweep >= kFewestSweeps && std::fabs(step_) < kSettled);
  }

  /// |z| from which on a residual is no chance.
  [[nodiscard]] double limit() const { return false_discovery_limit(histogram_, law_.mixture.core, kDiscoveryRate); }

  [[nodiscard]] double replaced() const {
    double count = 0.0;
    for (std::size_t t = 0; t < work_.state.size(); ++t) {
      count += work_.absent[t] == 0 && work_.state[t] != kGoodSample ? 1.0 : 0.0;
    }
    return count;
  }

  [[nodiscard]] std::vector<std::size_t> flagged() const {
    const double least = limit();
    std::vector<std::size_t> places;
    for (std::size_t t = 0; t < work_.state.size(); ++t) {
      if (work_.patch[t] != 0 || (work_.absent[t] == 0 && static_cast<double>(residual_[t]) > least)) {
        places.push_back(t);
      }
    }
    return places;
  }

  [[nodiscard]] const Work& work() const { return work_; }
  [[nodiscard]] double own_variance(std::size_t j) const {
    const double sd = fitter_.sd()(static_cast<Eigen::Index>(j));
    return sd * sd;
  }
  [[nodiscard]] Model model() const { return model_; }
  [[nodiscard]] std::vector<double> completed() const { return completed_; }

 private:
  Work work_;
  HaarCovariance& plan_;
  const RunControl& control_;
  ModelFitter fitter_;
  Random random_;
  std::vector<double> completed_;
  std::vector<float> residual_;
  ResidualHistogram histogram_;
  CompletionLaw law_;
  Model model_;
  bool started_ = false;
  double step_ = 0.0;  ///< of the logarithm of the residual variance, last sweep
};

/// Where gaps are all there is and leave most windows whole, these need no model.
void prefer_whole_windows(const Work& work, SampleWiseVariance& result) {
  const WholeWindowScan recorded(GappySamples{work.recorded, work.absent});
  std::vector<std::size_t> half;
  for (const std::size_t m : result.curve.half) {
    const auto share = static_cast<double>(recorded.windows(m)) / static_cast<double>(work.recorded.size() - 2 * m + 1);
    if (share < kMostlyWhole) {
      break;
    }
    half.push_back(m);
  }
  const std::vector<std::optional<WholeWindows>> windows = recorded.at(half);
  for (std::size_t j = 0; j < half.size(); ++j) {
    if (const std::optional<WholeWindows>& whole = windows[j]) {
      result.curve.variance[j] = whole->variance;
      result.efficiency[j] = whole->share;
    }
  }
}

/// Curve, model and series in the units of the record.
void restore_units(const Work& work, SampleWiseVariance& result) {
  for (double& variance : result.curve.variance) {
    variance *= work.unit * work.unit;
  }
  for (double& sample : result.completed) {
    sample = sample * work.unit + work.pivot;
  }
  for (Process& process : result.model) {
    process.parameters[0] *= work.unit;
  }
}

}  // namespace

SampleWiseVariance sample_wise_variance(const GappySamples& samples, HaarCovariance& plan,
                                        const SampleWiseOptions& options, const RunControl& control) {
  SampleWiseVariance result;
  const std::size_t absent = samples.missing_count();
  const std::size_t recorded = samples.size() - absent;
  if (recorded < kFewestRecorded || kMostMissingPerRow * recorded < absent) {
    result.outcome = SampleWiseOutcome::TooFewSamples;
    return result;
  }
  Work work;
  const auto ended = [&] {
    result.outcome = control.stop.stop_requested() ? SampleWiseOutcome::Cancelled : SampleWiseOutcome::Degenerate;
    return result;
  };
  if (!prepare(samples, options.look_for_errors, work, control)) {
    return ended();
  }
  Sampler sampler(std::move(work), plan, options.seed, control);
  DrawnCurves curves;
  HaarVariance last;
  double replaced = 0.0;
  std::size_t draws = 0;
  const std::size_t few = samples.size() < kManySamples ? 5 : 2;
  const std::size_t wanted = options.draws > 0 ? options.draws : few;
  bool settled = false;
  for (std::size_t sweep = 0; draws < wanted; ++sweep) {
    settled = settled || sampler.settled(sweep);
    std::optional<HaarVariance> curve = sampler.sweep();
    if (!curve) {
      return ended();
    }
    // Nothing to draw again: the record is its own completion.
    const bool clean = absent == 0 && sweep > 0 && std::isinf(sampler.limit()) && !sampler.work().patched;
    if (clean || settled) {
      last = clean ? haar_variance(sampler.work().recorded, 0.0) : *std::move(curve);
      curves.add(last);
      replaced += clean ? 0.0 : sampler.replaced();
      ++draws;
    }
    if (clean) {
      result.completed = sampler.work().recorded;
      break;
    }
  }
  result.replaced_share = replaced / static_cast<double>(draws) / static_cast<double>(recorded);
  result.flagged = sampler.flagged();
  result.model = sampler.model();
  if (result.replaced_share > kMostErrors) {
    result.outcome = SampleWiseOutcome::NotGaussian;
    return result;
  }
  result.outcome = SampleWiseOutcome::Estimated;
  result.curve = std::move(last);
  result.curve.variance = curves.mean();
  for (std::size_t j = 0; j < result.curve.scales(); ++j) {
    result.efficiency.push_back(curves.efficiency(j, sampler.own_variance(j)));
  }
  if (result.completed.empty()) {
    result.completed = sampler.completed();
  }
  if (!options.look_for_errors && absent > 0) {
    prefer_whole_windows(sampler.work(), result);
  }
  restore_units(sampler.work(), result);
  return result;
}

}  // namespace driftlab
