/// Mean effects: every candidate at a few bases without refitting, the best of them jointly with the base.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/search/slow_search.hpp"
#include "core/investigate/slow/screening.hpp"
#include "core/investigate/slow/step_scan.hpp"
#include "core/investigate/study/measured_constants.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
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
  parallel_for(threads_, group_.members.size(), [&](std::size_t r) {
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
    if (stop_.stop_requested()) {
      return;
    }
    const MeanEffect& effect = *templates.cause->as<MeanEffect>();
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
  const StepScan scan(series_, base, columns_with(accepted_), stop_);
  for (const Cause& cause : cause_registry()) {
    if (cause.as<MeanEffect>() == nullptr || !cause.as<MeanEffect>()->change_point) {
      continue;
    }
    for (std::size_t r = 0; r < series_.recordings.size(); ++r) {
      const StepScan::Best step = scan.best_in(r);
      const double penalty = step_penalty(*cause.as<MeanEffect>(), step.search_cost);
      const BlockRecording& blocks = series_.recordings[r];
      const double t0 = blocks.start_s + static_cast<double>(step.block) * series_.block_s();
      offer(best, Screened{&cause, {r}, t0, penalty, base_score + step.gain - penalty, base});
    }
  }
}

double SlowSearch::step_penalty(const MeanEffect& effect, double search_cost) const {
  return effect.penalty + choice_penalty(static_cast<double>(series_.recordings.size())) + search_cost;
}

void SlowSearch::refine_shape(Regressor& regressor, const SlowModel& model) const {
  const auto at = [&](double shape) {
    if (stop_.stop_requested()) {
      return 0.0;
    }
    std::vector<Regressor> with = accepted_;
    with.push_back(regressor);
    with.back().shape = shape;
    return evaluate_slow(series_, columns_with(with), model).log_likelihood;
  };
  const MeanEffect& effect = *regressor.cause->as<MeanEffect>();
  regressor.shape = effect.refinement.best_near(regressor.shape, at);
  if (effect.change_point) {
    const StepScan scan(series_, model, columns_with(accepted_), stop_);
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
    for (const Series& axis : member.recording->rate) {
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
    if (stop_.stop_requested()) {
      return evidence;
    }
    with.back().shape = candidate.shape;
    SlowFit fit = fit_slow(series_, columns_with(with), start, freedom());
    const MeanEffect& effect = *candidate.cause->as<MeanEffect>();
    if (effect.refinement.refined() || effect.change_point) {
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
  double penalty = candidate.penalty;
  if (candidate.cause->as<MeanEffect>()->change_point) {
    const StepScan scan(series_, best_fit.model, columns_with(accepted_), stop_);
    penalty = step_penalty(*candidate.cause->as<MeanEffect>(), scan.best_in(candidate.members.front()).search_cost);
  }
  evidence.score = evidence.gain - penalty;
  with.back().shape = best_shape;
  if (candidate.cause->as<MeanEffect>()->part_of_rate && share_of_rate(with, best_fit) > kLargestPart) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  if (candidate.cause->as<MeanEffect>()
          ->free_phase) {  // what free amplitudes gain over one amplitude is not the effect's
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

}  // namespace driftlab::investigate
