#include "core/investigate/search/slow_search.hpp"

#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Does vibration matter? Specific force along a gyro's axis whose fast part exceeds its slow part needs single
/// samples. Of very many, means over blocks tell enough, for what follows the vibration follows its power over a
/// second; single ones take up to 480 bytes each.
bool needs_full_rate(const ChannelGroup& group) {
  // At 480 bytes each half a gigabyte, what an investigation may take.
  constexpr std::size_t kMost = std::size_t{1} << 20U;
  std::size_t samples = 0;
  for (const auto& member : group.members) {
    samples += member.recording->count();
  }
  if (group.role.quantity != Quantity::AngularRate || samples > kMost) {
    return false;
  }
  for (const auto& member : group.members) {
    const Series& f = member.recording->force[group.axis()];
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

}  // namespace

SlowSearch::SlowSearch(const Study& study, const ChannelGroup& group, std::optional<SlowModel> given,
                       const RunControl& control)
    : study_(study), group_(group), given_(std::move(given)), threads_(control.threads), stop_(control.stop) {
  accepted_.push_back({nullptr, all_members(group), 0.0, 1});
}

void SlowSearch::set_data(const std::vector<Series>& error, const std::vector<std::vector<unsigned char>>& mask) {
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
    sum += cost_of(model.components[i].kind());
  }
  return sum;
}

double SlowSearch::first_level(const ProcessKind& kind, double share, double gathered, double level) const {
  const bool gathers = kind.parameters[0].second_power_halves < 0;
  return at_record_length(kind, gathers ? share * gathered * level : share * level, series_.longest_s());
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
  made.blocks.assign(static_cast<std::size_t>(cause->as<MeanEffect>()->columns), {});
  for (auto& column : made.blocks) {
    column.resize(group_.members.size());
  }
  std::vector<std::vector<double>> columns;
  for (std::size_t r = 0; r < group_.members.size(); ++r) {
    if (cause->as<MeanEffect>()->build(*group_.members[r].recording, group_, shape, columns)) {
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
    if (cause.as<MeanEffect>() == nullptr || cause.as<MeanEffect>()->change_point ||
        (cause.lacks != nullptr && !cause.lacks(study_, group_).empty())) {
      continue;
    }
    for (const double shape : cause.as<MeanEffect>()->shapes != nullptr ? cause.as<MeanEffect>()->shapes(group_)
                                                                        : std::vector<double>{0.0}) {
      wanted.push_back({&cause, shape});
    }
  }
  templates_.resize(wanted.size());
  parallel_for(
      threads_, wanted.size(), [&](std::size_t i) { templates_[i] = make_templates(wanted[i].cause, wanted[i].shape); },
      stop_);
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
    const bool own = regressor.cause != nullptr && regressor.cause->as<MeanEffect>()->free_phase;
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
  const auto add_best = [&](const SlowModel& base, const ProcessKind& kind) {
    SlowModel best = base;
    double top = -std::numeric_limits<double>::infinity();
    std::vector<double> betas{0.0};
    if (kind.has_shape()) {
      betas = {2.5 / series_.longest_s(), 0.02, 0.1, 0.4, 1.5};
    }
    for (const double beta : betas) {
      for (const double share : {0.01, 0.1, 1.0}) {
        SlowModel trial = base;
        trial.components.push_back(slow_component(kind, first_level(kind, share, 0.1, level), beta));
        const double l = stop_.stop_requested() ? top : evaluate_slow(series_, columns, trial).log_likelihood;
        if (l > top) {
          top = l;
          best = trial;
        }
      }
    }
    return best;
  };
  const ProcessKind& gauss_markov = registered<GaussMarkov>();
  const ProcessKind& walk = registered<RandomWalk>();
  std::vector<SlowModel> starts{white};
  const SlowFit one = fit_slow(series_, columns, add_best(white, gauss_markov), freedom());
  const SlowFit wandering = fit_slow(series_, columns, add_best(white, walk), freedom());
  starts.push_back(one.model);
  starts.push_back(wandering.model);
  starts.push_back(add_best(one.model, walk));
  starts.push_back(add_best(one.model, gauss_markov));
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
    parallel_for(threads_, starts.size(),
                 [&](std::size_t i) { orders_[i] = fit_slow(series_, columns, starts[i], freedom()); });
    // One order above the best two.
    if (orders_.back().log_likelihood - orders_[1].log_likelihood > 0.5 * cost_of(registered<GaussMarkov>())) {
      SlowModel more = orders_.back().model;
      more.components.push_back(
          slow_component(registered<RandomWalk>(), 0.02 * more.white / series_.block_s() / series_.longest_s()));
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
  exact_score_ = null_score_;
  if (!white_scale_.empty()) {
    SlowModel exact = null_.model;
    exact.white_scale.clear();
    exact_score_ = 2.0 * fit_slow(series_, columns, exact, freedom()).log_likelihood - cost(exact);
  }
  base_count_ = null_.model.components.size() - extra_.size();
  if (!extra_.empty()) {
    extra_.assign(null_.model.components.end() - static_cast<std::ptrdiff_t>(extra_.size()),
                  null_.model.components.end());
  }
  return null_;
}

void SlowSearch::accept(const Evidence& evidence) {
  if (evidence.cause->as<MeanEffect>() != nullptr) {
    accepted_.push_back(
        {evidence.cause, evidence.members, evidence.shape, width_of(*evidence.cause, evidence.members)});
    fit_null();
    // The shape once more under the fitted null.
    Regressor last = accepted_.back();
    accepted_.pop_back();
    refine_shape(last, null_.model);
    accepted_.push_back(last);
    fit_null();
    const auto first = static_cast<Eigen::Index>(regressor_of(evidence).value_or(0));
    const double upright =
        evidence.cause->as<MeanEffect>()->refinement.for_positive(last.shape, null_.amplitude[first]);
    if (upright != last.shape) {
      accepted_.back().shape = upright;
      fit_null();
    }
    return;
  }
  const BlockColumns columns = columns_with(accepted_);
  SlowFit best;
  for (const SlowFit& order : orders_) {
    SlowFit fit = fit_extra_freely(*evidence.cause->as<SlowNoise>()->kind, evidence.members, order.model, columns);
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
  white_scale_ = best.model.white_scale;
  extra_.push_back(best.model.components.back());
  extra_cause_.push_back(evidence.cause);
  null_ = std::move(best);
  fit_null();
}

void SlowSearch::reject(const Evidence& evidence) {
  if (evidence.cause->as<MeanEffect>() != nullptr) {
    std::erase_if(accepted_,
                  [&](const Regressor& r) { return r.cause == evidence.cause && r.members == evidence.members; });
  } else if (const auto it = std::find(extra_cause_.begin(), extra_cause_.end(), evidence.cause);
             it != extra_cause_.end()) {
    const auto at = it - extra_cause_.begin();
    null_.model.components.erase(null_.model.components.begin() + static_cast<std::ptrdiff_t>(base_count_) + at);
    extra_.erase(extra_.begin() + at);
    extra_cause_.erase(it);
  }
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

std::vector<Series> SlowSearch::residuals(const std::vector<Series>& error) const {
  std::vector<Series> result;
  for (std::size_t r = 0; r < group_.members.size(); ++r) {
    const StudyRecording& recording = *group_.members[r].recording;
    Series rest = error[r];
    std::size_t at = 0;
    for (const Regressor& regressor : accepted_) {
      const bool acts = std::find(regressor.members.begin(), regressor.members.end(), r) != regressor.members.end();
      std::vector<std::vector<double>> columns;
      if (regressor.cause == nullptr) {
        rest = rest.minus(null_.amplitude[static_cast<Eigen::Index>(at)]);
      } else if (acts && regressor.cause->as<MeanEffect>()->build(recording, group_, regressor.shape, columns)) {
        const auto k = static_cast<std::size_t>(std::find(regressor.members.begin(), regressor.members.end(), r) -
                                                regressor.members.begin());
        const std::size_t first = at + (regressor.cause->as<MeanEffect>()->free_phase ? k * columns.size() : 0);
        std::vector<double> e = rest.values();
        for (std::size_t c = 0; c < columns.size(); ++c) {
          const double a = null_.amplitude[static_cast<Eigen::Index>(first + c)];
          for (std::size_t i = 0; i < e.size(); ++i) {
            e[i] -= a * columns[c][i];
          }
        }
        rest = std::move(e);
      }
      at += static_cast<std::size_t>(regressor.columns);
    }
    result.push_back(rest.part(recording.begin, recording.count()));
  }
  return result;
}

}  // namespace driftlab::investigate
