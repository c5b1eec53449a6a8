#include "core/investigate/slow_search.hpp"

#include "core/investigate/causes/inputs.hpp"
#include "core/investigate/full_rate.hpp"
#include "core/investigate/parallel.hpp"
#include "core/investigate/screening.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kGaussMarkovCost = 6.0;
constexpr double kRandomWalkCost = 3.0;
constexpr std::size_t kJointFits = 7;  ///< candidates that are fitted jointly with the base
constexpr double kLargestPart = 0.3;   ///< of the reference rate (MeanEffect::part_of_rate)

bool same_scope(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) { return a == b; }

/// Does vibration matter? Specific force along a gyro's axis whose fast part exceeds its slow part needs single
/// samples.
bool needs_full_rate(const ChannelGroup& group) {
  if (group.role.quantity != Quantity::AngularRate) {
    return false;
  }
  for (const auto& member : group.members) {
    const std::vector<double>& f = member.recording->force[group.axis()];
    if (f.empty()) {
      continue;
    }
    const std::vector<double> fast = running_variance(f, 0.2 / member.recording->dt_s);
    double peak = 0.0;
    double mean = 0.0;
    for (const double v : fast) {
      peak = std::max(peak, v);
      mean += v / static_cast<double>(fast.size());
    }
    if (peak > 20.0 * mean || mean > 0.05) {
      return true;
    }
  }
  return false;
}

/// Regressor columns of an effect in a scope.
int width_of(const Cause& cause, const std::vector<std::size_t>& members) {
  return cause.mean->columns * (cause.mean->free_phase ? static_cast<int>(members.size()) : 1);
}

std::vector<unsigned char> membership(const std::vector<std::size_t>& members, std::size_t count) {
  std::vector<unsigned char> in(count, 0);
  for (const std::size_t r : members) {
    in[r] = 1;
  }
  return in;
}

}  // namespace

SlowSearch::SlowSearch(const Study& study, const ChannelGroup& group, std::optional<SlowModel> given, unsigned threads,
                       std::stop_token stop)
    : study_(study), group_(group), given_(std::move(given)), threads_(threads), stop_(std::move(stop)) {
  accepted_.push_back({nullptr, all_members(group), 0.0, 1});
}

void SlowSearch::set_data(const std::vector<std::vector<double>>& error,
                          const std::vector<std::vector<unsigned char>>& mask) {
  error_ = error;
  mask_ = mask;
  const bool full = needs_full_rate(group_);
  BlockSeries fresh = average_blocks(group_, mask, full);
  // The channel's own error has been averaged; the working copy (lines taken off) takes its place.
  for (std::size_t r = 0; r < group_.members.size(); ++r) {
    const Channel& channel = *group_.members[r].channel;
    BlockRecording& blocks = fresh.recordings[r];
    for (std::size_t b = 0; b < blocks.mean.size(); ++b) {
      double sum = 0.0;
      double count = 0.0;
      const std::size_t from = blocks.first + b * fresh.block;
      for (std::size_t i = from; i < from + fresh.block; ++i) {
        if (channel.valid[i] != 0 && (mask[r].empty() || mask[r][i] == 0)) {
          sum += error[r][i];
          count += 1.0;
        }
      }
      blocks.mean[b] = blocks.filled[b] > 0.0 ? sum / count : 0.0;
    }
  }
  const bool same_grid = !templates_.empty();
  series_ = std::move(fresh);
  if (!same_grid) {
    build_templates();
  }
}

void SlowSearch::set_white_scale(std::vector<double> scale) { white_scale_ = std::move(scale); }

double SlowSearch::cost(const SlowModel& model) const {
  if (given_) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i + extra_.size() < model.components.size(); ++i) {
    sum += model.components[i].kind == SlowKind::GaussMarkov ? kGaussMarkovCost : kRandomWalkCost;
  }
  return sum;
}

SlowFreedom SlowSearch::freedom() const {
  SlowFreedom freedom;
  freedom.stop = stop_;
  if (given_) {
    freedom.white = false;
    freedom.first_free = given_->components.size();
  }
  return freedom;
}

SlowSearch::Templates SlowSearch::make_templates(const Cause* cause, double shape) const {
  Templates made{cause, shape, {}};
  made.blocks.assign(static_cast<std::size_t>(cause->mean->columns), {});
  for (auto& column : made.blocks) {
    column.resize(group_.members.size());
  }
  std::vector<std::vector<double>> columns;
  for (std::size_t r = 0; r < group_.members.size(); ++r) {
    if (cause->mean->build(*group_.members[r].recording, group_, shape, columns)) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        made.blocks[c][r] = average_like(series_, r, columns[c]);
      }
    }
  }
  return made;
}

void SlowSearch::build_templates() {
  struct Wanted {
    const Cause* cause;
    double shape;
  };
  std::vector<Wanted> wanted;
  for (const Cause& cause : cause_registry()) {
    if (cause.mean == nullptr || cause.mean->change_point ||
        (cause.lacks != nullptr && !cause.lacks(study_, group_).empty())) {
      continue;
    }
    for (const double shape : cause.mean->shapes != nullptr ? cause.mean->shapes(group_) : std::vector<double>{0.0}) {
      wanted.push_back({&cause, shape});
    }
  }
  templates_.resize(wanted.size());
  parallel_for(wanted.size(), threads_,
               [&](std::size_t i) { templates_[i] = make_templates(wanted[i].cause, wanted[i].shape); });
}

const SlowSearch::Templates* SlowSearch::find_templates(const Cause* cause, double shape) const {
  for (const Templates& t : templates_) {
    if (t.cause == cause && t.shape == shape) {
      return &t;
    }
  }
  return nullptr;
}

BlockColumns SlowSearch::columns_with(const std::vector<Regressor>& regressors) const {
  std::size_t width = 1;
  for (const Regressor& regressor : regressors) {
    width += static_cast<std::size_t>(regressor.columns);
  }
  BlockColumns columns = BlockColumns::zeros(series_, width);
  for (std::size_t r = 0; r < series_.recordings.size(); ++r) {
    const auto& mean = series_.recordings[r].mean;
    for (std::size_t b = 0; b < mean.size(); ++b) {
      columns.rows[r][b * width] = mean[b];
    }
  }
  std::size_t at = 1;
  for (const Regressor& regressor : regressors) {
    Templates made;
    const Templates* source = nullptr;
    if (regressor.cause != nullptr) {
      source = find_templates(regressor.cause, regressor.shape);
      if (source == nullptr) {
        made = make_templates(regressor.cause, regressor.shape);
        source = &made;
      }
    }
    const bool own = regressor.cause != nullptr && regressor.cause->mean->free_phase;
    const std::size_t templates = source == nullptr ? 1 : source->blocks.size();
    for (std::size_t k = 0; k < regressor.members.size(); ++k) {
      const std::size_t r = regressor.members[k];
      for (std::size_t c = 0; c < templates; ++c) {
        const std::size_t place = at + c + (own ? k * templates : 0);
        for (std::size_t b = 0; b < series_.recordings[r].mean.size(); ++b) {
          const double value = source == nullptr ? 1.0 : source->blocks[c][r].empty() ? 0.0 : source->blocks[c][r][b];
          columns.rows[r][b * width + place] = value;
        }
      }
    }
    at += static_cast<std::size_t>(regressor.columns);
  }
  return columns;
}

std::vector<SlowModel> SlowSearch::starting_orders(const BlockColumns& columns) const {
  // White level from differences of neighbouring blocks; each further process from the best of a coarse grid.
  SlowModel white;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < series_.recordings.size(); ++r) {
    const BlockRecording& blocks = series_.recordings[r];
    const double scale = white_scale_.empty() ? 1.0 : white_scale_[r];
    for (std::size_t b = 1; b < blocks.mean.size(); ++b) {
      if (blocks.filled[b] > 0.0 && blocks.filled[b - 1] > 0.0) {
        const double d = blocks.mean[b] - blocks.mean[b - 1];
        square += d * d / scale;
        count += 2.0;
      }
    }
  }
  white.white = std::max(square / std::max(1.0, count), 1e-300) * series_.block_s();
  white.white_scale = white_scale_;
  const double level = white.white / series_.block_s();
  const auto add_best = [&](const SlowModel& base, SlowKind kind) {
    SlowModel best = base;
    double top = -std::numeric_limits<double>::infinity();
    std::vector<double> betas{0.0};
    if (kind == SlowKind::GaussMarkov) {
      betas = {2.5 / series_.longest_s(), 0.02, 0.1, 0.4, 1.5};
    }
    for (const double beta : betas) {
      for (const double share : {0.01, 0.1, 1.0}) {
        SlowModel trial = base;
        const double first = kind == SlowKind::RandomWalk ? share * 0.1 * level / series_.longest_s() : share * level;
        trial.components.push_back({kind, first, beta, {}});
        const double l = evaluate_slow(series_, columns, trial).log_likelihood;
        if (l > top) {
          top = l;
          best = trial;
        }
      }
    }
    return best;
  };
  std::vector<SlowModel> starts{white};
  const SlowFit one = fit_slow(series_, columns, add_best(white, SlowKind::GaussMarkov), freedom());
  const SlowFit walk = fit_slow(series_, columns, add_best(white, SlowKind::RandomWalk), freedom());
  starts.push_back(one.model);
  starts.push_back(walk.model);
  starts.push_back(add_best(one.model, SlowKind::RandomWalk));
  starts.push_back(add_best(one.model, SlowKind::GaussMarkov));
  return starts;
}

const SlowFit& SlowSearch::fit_null() {
  const BlockColumns columns = columns_with(accepted_);
  orders_.clear();
  if (given_) {
    SlowModel model = *given_;
    model.white_scale = white_scale_;
    model.components.insert(model.components.end(), extra_.begin(), extra_.end());
    orders_.push_back(fit_slow(series_, columns, model, freedom()));
  } else if (!extra_.empty()) {
    SlowModel model = null_.model;
    model.white_scale = white_scale_;
    orders_.push_back(fit_slow(series_, columns, model, freedom()));
  } else {
    const std::vector<SlowModel> starts = starting_orders(columns);
    orders_.resize(starts.size());
    parallel_for(starts.size(), threads_,
                 [&](std::size_t i) { orders_[i] = fit_slow(series_, columns, starts[i], freedom()); });
    // One order above the best two.
    if (orders_.back().log_likelihood - orders_[1].log_likelihood > 0.5 * kGaussMarkovCost) {
      SlowModel more = orders_.back().model;
      more.components.push_back(
          {SlowKind::RandomWalk, 0.02 * more.white / series_.block_s() / series_.longest_s(), 0.0, {}});
      orders_.push_back(fit_slow(series_, columns, more, freedom()));
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < orders_.size(); ++i) {
    if (2.0 * orders_[i].log_likelihood - cost(orders_[i].model) >
        2.0 * orders_[best].log_likelihood - cost(orders_[best].model)) {
      best = i;
    }
  }
  null_ = orders_[best];
  null_score_ = 2.0 * null_.log_likelihood - cost(null_.model);
  base_count_ = null_.model.components.size() - extra_.size();
  if (!extra_.empty()) {
    extra_.assign(null_.model.components.end() - static_cast<std::ptrdiff_t>(extra_.size()),
                  null_.model.components.end());
  }
  return null_;
}

/// A candidate of the screening: cause, scope, shape, and the base at which it did best.
struct SlowSearch::Screened {
  const Cause* cause = nullptr;
  std::vector<std::size_t> members;
  double shape = 0.0;
  double penalty = 0.0;
  double score = -1e300;  ///< penalised twice-log-likelihood at the screening base
  SlowModel base;
};

std::vector<SlowModel> SlowSearch::screening_bases() const {
  std::vector<SlowModel> bases;
  for (const SlowFit& fit : orders_) {
    bases.push_back(fit.model);
  }
  if (given_ || !extra_.empty() || group_.members.size() < 2) {
    return bases;
  }
  // Fits to single recordings: where the effect is absent, the base is clean.
  const std::size_t pooled = bases.size();
  bases.resize(pooled + group_.members.size());
  parallel_for(group_.members.size(), threads_, [&](std::size_t r) {
    BlockSeries single = series_;
    single.recordings = {series_.recordings[r]};
    single.recordings[0].pattern = 0;
    BlockColumns columns = BlockColumns::zeros(single, 2);
    for (std::size_t b = 0; b < single.recordings[0].mean.size(); ++b) {
      columns.rows[0][2 * b] = single.recordings[0].mean[b];
      columns.rows[0][2 * b + 1] = 1.0;
    }
    SlowModel start = null_.model;
    start.white_scale.clear();
    if (!white_scale_.empty()) {
      start.white *= white_scale_[r];
    }
    SlowFreedom quick;
    quick.stop = stop_;
    quick.iterations = 8;
    SlowModel model = fit_slow(single, columns, start, quick).model;
    if (!white_scale_.empty()) {
      model.white /= white_scale_[r];
    }
    model.white_scale = white_scale_;
    bases[pooled + r] = std::move(model);
  });
  return bases;
}

void SlowSearch::screen(const SlowModel& base, double base_score, std::vector<Screened>& best) const {
  const BlockColumns fixed = columns_with(accepted_);
  const std::size_t fixed_width = fixed.width;
  const auto moving = moving_members(group_);
  const auto singles = group_.members.size();
  for (const Templates& templates : templates_) {
    const MeanEffect& effect = *templates.cause->mean;
    BlockColumns columns = BlockColumns::zeros(series_, fixed_width + templates.blocks.size());
    for (std::size_t r = 0; r < series_.recordings.size(); ++r) {
      for (std::size_t b = 0; b < series_.recordings[r].mean.size(); ++b) {
        std::copy_n(&fixed.rows[r][b * fixed_width], fixed_width, &columns.rows[r][b * columns.width]);
        for (std::size_t c = 0; c < templates.blocks.size(); ++c) {
          if (!templates.blocks[c][r].empty()) {
            columns.rows[r][b * columns.width + fixed_width + c] = templates.blocks[c][r][b];
          }
        }
      }
    }
    const ScopedGram gram(whiten(series_, base, columns).columns, fixed_width);
    std::vector<std::vector<std::size_t>> scopes;
    if (effect.scope_all) {
      scopes.push_back(all_members(group_));
    }
    if (effect.scope_moving && moving.size() > 1 && moving.size() < singles) {
      scopes.push_back(moving);
    }
    if (effect.scope_single && singles > 1) {
      for (std::size_t r = 0; r < singles; ++r) {
        scopes.push_back({r});
      }
    }
    double penalty = effect.penalty + choice_penalty(static_cast<double>(scopes.size()));
    if (effect.shape_penalty != nullptr) {
      penalty += effect.shape_penalty(templates.shape);
    }
    for (const auto& scope : scopes) {
      const double gain = effect.free_phase ? gram.surprise_of_common_amplitude(scope) : gram.gain(scope);
      const double score = base_score + gain - penalty;
      offer(best, Screened{templates.cause, scope, templates.shape, penalty, score, base});
    }
  }
}

void SlowSearch::screen_steps(const SlowModel& base, double base_score, std::vector<Screened>& best) const {
  const Cause* const cause = find_cause("bias_step");
  const StepScan scan(series_, base, columns_with(accepted_));
  for (std::size_t r = 0; r < series_.recordings.size(); ++r) {
    const StepScan::Best step = scan.best_in(r);
    const double penalty = cause->mean->penalty + choice_penalty(static_cast<double>(series_.recordings.size()));
    const BlockRecording& blocks = series_.recordings[r];
    const double t0 = blocks.start_s + static_cast<double>(step.block) * series_.block_s();
    offer(best, Screened{cause, {r}, t0, penalty, base_score + step.gain - penalty, base});
  }
}

void SlowSearch::refine_shape(Regressor& regressor, const SlowModel& model) const {
  const auto at = [&](double shape) {
    std::vector<Regressor> with = accepted_;
    with.push_back(regressor);
    with.back().shape = shape;
    return evaluate_slow(series_, columns_with(with), model).log_likelihood;
  };
  const MeanEffect& effect = *regressor.cause->mean;
  if (effect.continuous) {
    const bool from_zero = regressor.shape < 1.0;
    double width = from_zero ? 2.0 : 0.4;  // seconds near zero, else a share
    double top = at(regressor.shape);
    for (int i = 0; i < 7; ++i, width *= 0.55) {
      for (const double sign : {-1.0, 1.0}) {
        const double trial = from_zero ? regressor.shape + sign * width : regressor.shape * std::exp(sign * width);
        if (trial < 0.0) {
          continue;
        }
        const double l = at(trial);
        if (l > top) {
          top = l;
          regressor.shape = trial;
          break;
        }
      }
    }
  } else if (effect.change_point) {
    const StepScan scan(series_, model, columns_with(accepted_));
    const std::size_t r = regressor.members.front();
    const StepScan::Best step = scan.best_in(r);
    regressor.shape = series_.recordings[r].start_s + static_cast<double>(step.block) * series_.block_s();
  }
}

double SlowSearch::share_of_rate(const std::vector<Regressor>& regressors, const SlowFit& fit) const {
  const BlockColumns columns = columns_with(regressors);
  const std::size_t last = columns.width - 1;
  const double amplitude = std::fabs(fit.amplitude[static_cast<Eigen::Index>(last - 1)]);
  double effect = 0.0;
  for (const auto& rows : columns.rows) {
    for (std::size_t b = 0; b * columns.width < rows.size(); ++b) {
      effect = std::max(effect, amplitude * std::fabs(rows[b * columns.width + last]));
    }
  }
  double rate = 0.0;
  for (const auto& member : group_.members) {
    for (const std::vector<double>& axis : member.recording->rate) {
      for (const double w : axis) {
        rate = std::max(rate, std::fabs(w));
      }
    }
  }
  return rate > 0.0 ? effect / rate : 0.0;
}

Evidence SlowSearch::fit_jointly(const Screened& candidate) const {
  const Regressor regressor{candidate.cause, candidate.members, candidate.shape,
                            width_of(*candidate.cause, candidate.members)};
  std::vector<Regressor> with = accepted_;
  with.push_back(regressor);
  Evidence evidence;
  evidence.cause = candidate.cause;
  evidence.members = candidate.members;
  evidence.freedom = static_cast<double>(regressor.columns);
  double best = -1e300;
  SlowFit best_fit;
  double best_shape = candidate.shape;
  std::vector<SlowModel> starts{candidate.base};
  if (!given_ && extra_.empty()) {  // one process less, and the null's own optimum
    for (std::size_t i = 0; i < candidate.base.components.size(); ++i) {
      SlowModel less = candidate.base;
      less.components.erase(less.components.begin() + static_cast<std::ptrdiff_t>(i));
      starts.push_back(std::move(less));
    }
    starts.push_back(null_.model);
  }
  for (const SlowModel& start : starts) {
    with.back().shape = candidate.shape;
    SlowFit fit = fit_slow(series_, columns_with(with), start, freedom());
    if (candidate.cause->mean->continuous || candidate.cause->mean->change_point) {
      Regressor refined = with.back();
      refine_shape(refined, fit.model);
      if (refined.shape != with.back().shape) {
        with.back().shape = refined.shape;
        fit = fit_slow(series_, columns_with(with), fit.model, freedom());
      }
    }
    const double score = 2.0 * fit.log_likelihood - cost(fit.model);
    if (score > best) {
      best = score;
      best_fit = fit;
      best_shape = with.back().shape;
    }
  }
  evidence.shape = best_shape;
  evidence.gain = best - null_score_;
  evidence.score = best - null_score_ - candidate.penalty;
  with.back().shape = best_shape;
  if (candidate.cause->mean->part_of_rate && share_of_rate(with, best_fit) > kLargestPart) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  if (candidate.cause->mean->free_phase) {  // what free amplitudes gain over one amplitude is not the effect's
    const BlockColumns columns = columns_with(with);
    const std::size_t own = columns.width - static_cast<std::size_t>(with.back().columns);
    const ScopedGram gram(whiten(series_, best_fit.model, columns).columns, own);
    double separate = 0.0;
    for (const std::size_t r : candidate.members) {
      separate += gram.gain_of_member(r, candidate.members);
    }
    evidence.score += gram.surprise_of_members(candidate.members) - separate;
  }
  return evidence;
}

SlowFit SlowSearch::fit_extra(SlowKind kind, const std::vector<std::size_t>& scope, const SlowModel& base,
                              const BlockColumns& columns) const {
  const double level = base.white / series_.block_s();
  std::vector<unsigned char> in;
  if (!same_scope(scope, all_members(group_))) {
    in = membership(scope, group_.members.size());
  }
  std::vector<double> betas{0.0};
  if (kind == SlowKind::GaussMarkov) {
    betas = {3.0 / series_.longest_s(), 0.03, 0.15, 0.6, 2.0};
  }
  SlowModel best = base;
  double top = -std::numeric_limits<double>::infinity();
  for (const double beta : betas) {
    for (const double share : {0.003, 0.03, 0.3}) {
      SlowModel trial = base;
      const double first = kind == SlowKind::RandomWalk ? share * 0.3 * level / series_.longest_s() : share * level;
      trial.components.push_back({kind, first, beta, in});
      const double l = evaluate_slow(series_, columns, trial).log_likelihood;
      if (l > top) {
        top = l;
        best = trial;
      }
    }
  }
  return fit_slow(series_, columns, best, freedom());
}

std::vector<Evidence> SlowSearch::examine_slow() const {
  const BlockColumns columns = columns_with(accepted_);
  struct Job {
    const Cause* cause;
    std::vector<std::size_t> scope;
    std::size_t scopes;
    SlowModel base;
  };
  std::vector<Job> jobs;
  const auto everyone = all_members(group_);
  const auto moving = moving_members(group_);
  for (const Cause& cause : cause_registry()) {
    if (cause.slow == nullptr) {
      continue;
    }
    std::vector<std::vector<std::size_t>> scopes;
    if (*cause.slow == SlowKind::Offset) {
      if (group_.members.size() > 2) {
        scopes.push_back(everyone);
      }
    } else {
      if (given_) {
        scopes.push_back(everyone);
      }
      if (!moving.empty() && moving.size() < everyone.size()) {
        scopes.push_back(moving);
      }
    }
    for (const auto& scope : scopes) {
      jobs.push_back({&cause, scope, scopes.size(), null_.model});
      if (!given_ && extra_.empty()) {
        for (const SlowFit& order : orders_) {
          if (order.model.components.size() + 1 == null_.model.components.size()) {
            jobs.push_back({&cause, scope, scopes.size(), order.model});
          }
        }
      }
    }
  }
  std::vector<Evidence> results(jobs.size());
  parallel_for(jobs.size(), threads_, [&](std::size_t i) {
    const Job& job = jobs[i];
    const SlowKind kind = *job.cause->slow;
    const SlowFit fit = fit_extra(kind, job.scope, job.base, columns);
    SlowModel base = fit.model;
    const SlowComponent extra = base.components.back();
    base.components.pop_back();
    Evidence& evidence = results[i];
    evidence.cause = job.cause;
    evidence.members = job.scope;
    evidence.freedom = kind == SlowKind::GaussMarkov ? 2.0 : 1.0;
    evidence.gain = 2.0 * fit.log_likelihood - cost(base) - null_score_;
    evidence.score = evidence.gain - (kind == SlowKind::GaussMarkov ? kGaussMarkovCost : kRandomWalkCost) -
                     choice_penalty(static_cast<double>(job.scopes));
    evidence.shape = extra.beta;
  });
  std::vector<Evidence> found;
  for (Evidence& evidence : results) {
    auto same = std::find_if(found.begin(), found.end(), [&](const Evidence& e) { return e.cause == evidence.cause; });
    if (same == found.end()) {
      found.push_back(evidence);
    } else if (evidence.score > same->score) {
      *same = evidence;
    }
  }
  return found;
}

std::vector<Evidence> SlowSearch::examine() {
  const std::vector<SlowModel> bases = screening_bases();
  std::vector<std::vector<Screened>> per_base(bases.size());
  parallel_for(bases.size(), threads_, [&](std::size_t i) {
    if (stop_.stop_requested()) {
      return;
    }
    const SlowFit at_base = evaluate_slow(series_, columns_with(accepted_), bases[i]);
    const double base_score = 2.0 * at_base.log_likelihood - cost(bases[i]);
    screen(bases[i], base_score, per_base[i]);
    screen_steps(bases[i], base_score, per_base[i]);
  });
  std::vector<Screened> candidates;
  for (auto& of_base : per_base) {
    for (Screened& candidate : of_base) {
      offer(candidates, std::move(candidate));
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Screened& a, const Screened& b) { return a.score > b.score; });
  // The most promising; of each cause at most two scopes; nothing hopeless.
  std::vector<Screened> chosen;
  for (const Screened& candidate : candidates) {
    const bool already = std::any_of(accepted_.begin(), accepted_.end(), [&](const Regressor& r) {
      return r.cause == candidate.cause && r.members == candidate.members;
    });
    const auto of_cause =
        std::count_if(chosen.begin(), chosen.end(), [&](const Screened& c) { return c.cause == candidate.cause; });
    if (already || of_cause >= 2 || chosen.size() >= kJointFits || candidate.score < null_score_ - 12.0) {
      continue;
    }
    chosen.push_back(candidate);
  }
  // Declared rivals of the leader are fitted too: its margin over them is what the report claims.
  if (!chosen.empty()) {
    for (const std::string_view rival : chosen.front().cause->rivals) {
      const bool there =
          std::any_of(chosen.begin(), chosen.end(), [&](const Screened& c) { return c.cause->name == rival; });
      const auto it =
          std::find_if(candidates.begin(), candidates.end(), [&](const Screened& c) { return c.cause->name == rival; });
      if (!there && it != candidates.end() && it->score > chosen.front().score - 60.0) {
        chosen.push_back(*it);
      }
    }
  }
  std::vector<Evidence> found(chosen.size());
  parallel_for(chosen.size(), threads_, [&](std::size_t i) { found[i] = fit_jointly(chosen[i]); });
  if (stop_.stop_requested()) {
    return {};
  }
  for (Evidence& evidence : examine_slow()) {
    found.push_back(std::move(evidence));
  }
  return found;
}

void SlowSearch::accept(const Evidence& evidence) {
  if (evidence.cause->mean != nullptr) {
    accepted_.push_back(
        {evidence.cause, evidence.members, evidence.shape, width_of(*evidence.cause, evidence.members)});
    fit_null();
    // The shape once more under the fitted null.
    Regressor last = accepted_.back();
    accepted_.pop_back();
    refine_shape(last, null_.model);
    accepted_.push_back(last);
    fit_null();
    return;
  }
  const BlockColumns columns = columns_with(accepted_);
  SlowFit best;
  for (const SlowFit& order : orders_) {
    SlowFit fit = fit_extra(*evidence.cause->slow, evidence.members, order.model, columns);
    SlowModel base = fit.model;
    base.components.pop_back();
    SlowModel best_base = best.model;
    if (!best_base.components.empty()) {
      best_base.components.pop_back();
    }
    if (2.0 * fit.log_likelihood - cost(base) > 2.0 * best.log_likelihood - cost(best_base)) {
      best = std::move(fit);
    }
  }
  extra_.push_back(best.model.components.back());
  extra_cause_.push_back(evidence.cause);
  null_ = std::move(best);
  fit_null();
}

void SlowSearch::reject(const Evidence& evidence) {
  if (evidence.cause->mean != nullptr) {
    std::erase_if(accepted_,
                  [&](const Regressor& r) { return r.cause == evidence.cause && r.members == evidence.members; });
  } else if (const auto it = std::find(extra_cause_.begin(), extra_cause_.end(), evidence.cause);
             it != extra_cause_.end()) {
    const auto at = it - extra_cause_.begin();
    null_.model.components.erase(null_.model.components.begin() + static_cast<std::ptrdiff_t>(base_count_) + at);
    extra_.erase(extra_.begin() + at);
    extra_cause_.erase(it);
  }
  fit_null();
}

std::optional<std::size_t> SlowSearch::regressor_of(const Evidence& evidence) const {
  std::size_t at = 0;
  for (const Regressor& regressor : accepted_) {
    if (regressor.cause == evidence.cause && regressor.members == evidence.members && regressor.cause != nullptr) {
      return at;
    }
    at += static_cast<std::size_t>(regressor.columns);
  }
  return std::nullopt;
}

SlowModel SlowSearch::base() const {
  SlowModel model = null_.model;
  model.components.resize(base_count_);
  return model;
}

std::vector<std::vector<double>> SlowSearch::residuals(const std::vector<std::vector<double>>& error) const {
  std::vector<std::vector<double>> result;
  std::vector<std::vector<double>> columns;
  for (std::size_t r = 0; r < group_.members.size(); ++r) {
    const StudyRecording& recording = *group_.members[r].recording;
    std::vector<double> e = error[r];
    std::size_t at = 0;
    for (const Regressor& regressor : accepted_) {
      const bool acts = std::find(regressor.members.begin(), regressor.members.end(), r) != regressor.members.end();
      if (regressor.cause == nullptr) {
        for (double& v : e) {
          v -= null_.amplitude[static_cast<Eigen::Index>(at)];
        }
      } else if (acts && regressor.cause->mean->build(recording, group_, regressor.shape, columns)) {
        const auto k = static_cast<std::size_t>(std::find(regressor.members.begin(), regressor.members.end(), r) -
                                                regressor.members.begin());
        const std::size_t first = at + (regressor.cause->mean->free_phase ? k * columns.size() : 0);
        for (std::size_t c = 0; c < columns.size(); ++c) {
          const double a = null_.amplitude[static_cast<Eigen::Index>(first + c)];
          for (std::size_t i = 0; i < e.size(); ++i) {
            e[i] -= a * columns[c][i];
          }
        }
      }
      at += static_cast<std::size_t>(regressor.columns);
    }
    result.emplace_back(e.begin() + static_cast<std::ptrdiff_t>(recording.begin),
                        e.begin() + static_cast<std::ptrdiff_t>(recording.end));
  }
  return result;
}

}  // namespace driftlab::investigate
