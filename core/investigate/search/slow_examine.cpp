/// One look at a group: slow processes of their own, and the mean effects that screening proposes.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/search/slow_search.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/investigate/slow/screening.hpp"
#include "core/process/constant_offset.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kLevelCost = 3.0;  ///< log likelihood that the free level of one recording has to gain

constexpr std::size_t kJointFits = 7;  ///< candidates that are fitted jointly with the base

bool same_scope(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) { return a == b; }

std::vector<unsigned char> membership(const std::vector<std::size_t>& members, std::size_t count) {
  std::vector<unsigned char> in(count, 0);
  for (const std::size_t r : members) {
    in[r] = 1;
  }
  return in;
}

}  // namespace

SlowFit SlowSearch::fit_extra(const ProcessKind& kind, const std::vector<std::size_t>& scope, const SlowModel& base,
                              const BlockColumns& columns) const {
  const double level = base.white / series_.block_s();
  std::vector<unsigned char> in;
  if (!same_scope(scope, all_members(group_))) {
    in = membership(scope, group_.members.size());
  }
  std::vector<double> betas{0.0};
  if (kind.has_shape()) {
    betas = {3.0 / series_.longest_s(), 0.03, 0.15, 0.6, 2.0};
  }
  SlowModel best = base;
  double top = -std::numeric_limits<double>::infinity();
  for (const double beta : betas) {
    for (const double share : {0.003, 0.03, 0.3}) {
      SlowModel trial = base;
      trial.components.push_back(slow_component(kind, first_level(kind, share, 0.3, level), beta, in));
      const double l = stop_.stop_requested() ? top : evaluate_slow(series_, columns, trial).log_likelihood;
      if (l > top) {
        top = l;
        best = trial;
      }
    }
  }
  return fit_slow(series_, columns, best, freedom());
}

SlowFit SlowSearch::fit_extra_freely(const ProcessKind& kind, const std::vector<std::size_t>& scope,
                                     const SlowModel& base, const BlockColumns& columns) const {
  SlowFit fit = fit_extra(kind, scope, base, columns);
  if (base.white_scale.empty()) {
    return fit;
  }
  SlowModel level = base;
  level.white_scale.clear();
  const SlowFit without = fit_extra(kind, scope, level, columns);
  // Levels were chosen one by one at full rate: each must be worth its freedom.
  const auto levels = static_cast<double>(base.white_scale.size());
  return without.log_likelihood + kLevelCost * levels > fit.log_likelihood ? without : fit;
}

bool SlowSearch::has_extra(const Cause& cause, const std::vector<std::size_t>& scope) const {
  for (std::size_t i = 0; i < extra_.size(); ++i) {
    const bool same = std::all_of(scope.begin(), scope.end(), [&](std::size_t r) { return extra_[i].acts_in(r); });
    if (extra_cause_[i] == &cause && same) {
      return true;
    }
  }
  return false;
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
    if (cause.as<SlowNoise>() == nullptr) {
      continue;
    }
    std::vector<std::vector<std::size_t>> scopes;
    if (cause.as<SlowNoise>()->kind == &constant_offset()) {
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
      if (has_extra(cause, scope)) {
        continue;  // more of the same is a level, which the fit of the null has found
      }
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
  parallel_for(threads_, jobs.size(), [&](std::size_t i) {
    const Job& job = jobs[i];
    const ProcessKind& kind = *job.cause->as<SlowNoise>()->kind;
    const SlowFit fit = fit_extra_freely(kind, job.scope, job.base, columns);
    SlowModel base = fit.model;
    const SlowComponent extra = base.components.back();
    base.components.pop_back();
    Evidence& evidence = results[i];
    evidence.cause = job.cause;
    evidence.members = job.scope;
    evidence.freedom = kind.has_shape() ? 2.0 : 1.0;
    // What needs no nuisance of levels is measured against the better null, with it or without it; and once it is far
    // better than that, against the model that was given.
    const bool exact = fit.model.white_scale.empty();
    evidence.gain = 2.0 * fit.log_likelihood - cost(base) - (exact ? std::max(null_score_, exact_score_) : null_score_);
    if (given_ && exact && evidence.gain > kThreshold) {
      evidence.gain += std::max(0.0, null_score_ - exact_score_);
    }
    evidence.score = evidence.gain - cost_of(kind) - choice_penalty(static_cast<double>(job.scopes));
    evidence.shape = extra.process.only_shape();
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
  parallel_for(threads_, bases.size(), [&](std::size_t i) {
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
  std::erase_if(candidates, [&](const Screened& candidate) {
    return std::any_of(accepted_.begin(), accepted_.end(), [&](const Regressor& r) {
      return r.cause == candidate.cause && r.members == candidate.members;
    });
  });
  for (const Screened& candidate : candidates) {
    const auto of_cause =
        std::count_if(chosen.begin(), chosen.end(), [&](const Screened& c) { return c.cause == candidate.cause; });
    if (of_cause >= 2 || chosen.size() >= kJointFits || candidate.score < null_score_ - 12.0) {
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
  parallel_for(threads_, chosen.size(), [&](std::size_t i) { found[i] = fit_jointly(chosen[i]); }, stop_);
  if (stop_.stop_requested()) {
    return {};
  }
  for (Evidence& evidence : examine_slow()) {
    found.push_back(std::move(evidence));
  }
  return found;
}

}  // namespace driftlab::investigate
