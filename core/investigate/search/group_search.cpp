#include "core/investigate/search/group_search.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/base_quantization.hpp"
#include "core/investigate/search/candidates.hpp"
#include "core/investigate/search/file_facts.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/investigate/search/hold_out.hpp"
#include "core/investigate/search/joint_refit.hpp"
#include "core/investigate/search/slow_search.hpp"
#include "core/investigate/search/take_colour.hpp"
#include "core/investigate/search/take_out.hpp"
#include "core/investigate/search/take_switching.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "core/investigate/search/usable_group.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

/// Rounds of the slow search. Chosen, not measured.
constexpr int kRounds = 4;

/// One group's state through the search.
class GroupSearch {
 public:
  /// What is found is written to `outcome`.
  GroupSearch(const Study& study, const ChannelGroup& group, std::size_t index, const RunControl& control,
              GroupOutcome& outcome)
      : study_(study), group_(group), index_(index), control_(control), outcome_(outcome) {}

  void run() {
    const UsableGroup usable = usable_group(group_);
    outcome_.usable = usable.why_not.empty();
    outcome_.why_not = usable.why_not;
    outcome_.needs = usable.needs;
    if (!outcome_.usable) {
      return;
    }
    control_.report("facts of " + group_.column, 0.0);
    FileFacts facts = look_at_files(group_, control_.stop);
    mask_ = std::move(facts.mask);
    lattice_step_ = facts.lattice_step;
    outcome_.found = std::move(facts.found);
    outcome_.examined = outcome_.found;
    for (const auto& member : group_.members) {
      error_.push_back(member.channel->error);
    }
    if (!stopped()) {
      search_slow();
    }
    if (!stopped()) {
      control_.report("noise of " + group_.column, 0.9);
      search_full_rate();
    }
    if (!given_ && !stopped() && shares_in_noise(outcome_.found)) {
      outcome_.model.beside.noise =
          base_of(refit_jointly(outcome_.after, mask_, quantization_, outcome_.found, control_.stop), outcome_.found);
    }
    for (Evidence& evidence : outcome_.found) {
      evidence.group = index_;
      for (Evidence& rival : evidence.rivals) {
        rival.group = index_;
      }
    }
  }

 private:
  [[nodiscard]] bool stopped() const { return control_.stop.stop_requested(); }

  /// `error[r]`, over the grid of member r, less what the search has accepted, under the null of the search.
  [[nodiscard]] FullRate full_rate(const SlowSearch& search, const std::vector<Series>& error,
                                   bool whiten_further) const {
    FullRateOptions options;
    options.given = given_.has_value();
    options.whiten_further = whiten_further;
    options.lattice_step = lattice_step_;
    options.stop = control_.stop;
    SlowModel model = search.null_fit().model;
    model.white_scale.clear();
    if (given_) {
      model.white = given_white_;
      if (quantization_ > 0.0) {
        options.quantization = quantization_;
        options.given = false;
        options.whiten_further = true;
      }
      return look_at_full_rate(study_, group_, model, search.residuals(error), mask_, options);
    }
    options.innovations = false;
    options.quantization = quantization_;
    FullRate data = look_at_full_rate(study_, group_, model, search.residuals(error), mask_, options);
    model.white = white_at_full_rate(data);
    options.innovations = true;
    options.whiten_further = whiten_further || quantization_ > 0.0;
    return look_at_full_rate(study_, group_, model, std::move(data.residual), mask_, options);
  }

  /// The given model as blocks see it: of differenced noise only the two ends of a block remain, 2 Q^2/block^2.
  [[nodiscard]] std::optional<SlowModel> block_model() const {
    std::optional<SlowModel> model = given_;
    if (model && quantization_ > 0.0) {
      model->white += 2.0 * quantization_ * 5.0;  // blocks of about 1/5 s
    }
    return model;
  }

  void search_slow() {
    const double dt = group_.members.front().recording->dt_s;
    if (!given_ && applies(study_.baseline, group_)) {
      given_ = given_model(study_.baseline, group_);
      given_->white += lattice_step_ * lattice_step_ / 12.0 * dt;
      given_white_ = given_->white;
      quantization_ = given_quantization(study_.baseline, group_);
      take_given_means(study_.baseline, group_, error_);
    }
    SlowSearch search(study_, group_, block_model(), control_);
    search.set_data(error_, mask_);
    search.fit_null();
    std::vector<Evidence> slow_found;
    bool levels_in_question = false;
    for (int round = 0; round < kRounds && !stopped(); ++round) {
      control_.report("search " + group_.column, 0.1 + 0.6 * round / kRounds);
      FullRate data = full_rate(search, error_, false);
      if (round == 0 || levels_in_question) {
        levels_in_question = false;
        const std::vector<double> scale = white_scale_of(data);
        if (!scale.empty()) {
          search.set_white_scale(scale);
          search.fit_null();
          data = full_rate(search, error_, false);
        }
      }
      if (stopped()) {
        break;
      }
      if (round == 0 && !given_) {
        quantization_ = quantization_of_base(data);
        data = quantization_ > 0.0 ? full_rate(search, error_, false) : std::move(data);
      }
      std::vector<Evidence> candidates = lines_in(data);
      // A line far above anything slow could be is taken before the slower search is made.
      const Evidence* best = strongest(candidates);
      const bool clear_line = best != nullptr && best->score > 60.0 && best->shape > 2.5;
      std::optional<Evidence> winner = clear_line ? choose(data, candidates) : std::nullopt;
      const bool looked_for_slow = !winner;  // also where the clear line is none, held out
      if (looked_for_slow) {
        for (Evidence& evidence : search.examine()) {
          candidates.push_back(std::move(evidence));
        }
        winner = choose(data, candidates);
      }
      keep_best(outcome_.examined, candidates);
      keep_last(outcome_.remaining, candidates, [&](const Cause& cause) {
        return cause.as<SpectralLine>() != nullptr || (cause.is_slow() && looked_for_slow);
      });
      if (!winner) {
        break;
      }
      if (const SpectralLine* const found_line = winner->cause->as<SpectralLine>()) {
        for (const std::size_t r : winner->members) {
          const std::vector<double> line = found_line->values(data, r, *winner);
          const std::size_t begin = group_.members[r].recording->begin;
          std::vector<double> rest = error_[r].values();
          for (std::size_t i = 0; i < line.size(); ++i) {
            rest[begin + i] -= line[i];
          }
          error_[r] = std::move(rest);
        }
        search.set_data(error_, mask_);
        if (stopped()) {
          break;
        }
        search.fit_null();
        outcome_.found.push_back(*std::move(winner));
      } else {
        const bool had_levels = search.has_white_scale();
        search.accept(*winner);
        levels_in_question = had_levels && !search.has_white_scale();
        slow_found.push_back(*std::move(winner));
      }
    }
    if (stopped()) {
      return;
    }
    if (take_switching_off(search)) {
      return search_slow();
    }
    control_.report("intervals of " + group_.column, 0.7);
    // Backward check: what gains nothing on samples it was not fitted to goes out again, the last one first.
    for (std::size_t i = slow_found.size(); i-- > 0 && !stopped();) {
      search.hold_out(slow_found[i]);
      if (slow_found[i].heldout_gain <= 0.0) {
        search.reject(slow_found[i]);
        search.fit_null();
        refuse(*slow_found[i].cause);
        slow_found.erase(slow_found.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
    for (Evidence& evidence : slow_found) {
      if (stopped()) {
        return;
      }
      search.describe(evidence);
      // A drift that all recordings share is part of an automatic baseline.
      const bool shared = evidence.members.size() == group_.members.size() && !evidence.parameters.empty();
      const MeanEffect* const mean = evidence.cause->as<MeanEffect>();
      if (!given_ && shared && mean != nullptr && mean->drift_of_baseline) {
        outcome_.model.beside.drift = evidence.parameters[0].estimate.value;
      } else {
        outcome_.found.push_back(std::move(evidence));
      }
    }
    if (stopped()) {
      return;
    }
    ChannelModel& model = outcome_.model;
    model.channel = group_.column;
    model.unit = group_.unit;
    model.quantity = group_.role.quantity;
    outcome_.after = full_rate(search, error_, !given_);
    model.given = given_.has_value();
    model.given_processes = given_ ? processes_of(study_.baseline, group_) : Model{};
    model.beside.noise = search.base();
    model.beside.noise.white = outcome_.after.model.white;
    model.beside.bias = search.null_fit().amplitude[0];
    model.beside.quantization = given_ ? 0.0 : quantization_;
    if (!stopped()) {
      settle_alone(search);
    }
  }

  /// What gains nothing on data it was not fitted to has not been seen.
  void refuse(const Cause& cause) {
    for (std::vector<Evidence>* const list : {&outcome_.examined, &outcome_.remaining}) {
      for (Evidence& evidence : *list) {
        evidence.score = evidence.cause == &cause ? std::min(0.0, evidence.score) : evidence.score;
      }
    }
  }

  /// The base of somebody who knows of no effect, fitted to the recordings as they came, and they under it. The search
  /// is at its end: it forgets what it has accepted.
  void settle_alone(SlowSearch& search) {
    ChannelModel& model = outcome_.model;
    model.alone = model.beside;
    if (outcome_.found.empty()) {
      outcome_.before = outcome_.after;
      return;
    }
    std::vector<Series> whole;
    for (const auto& member : group_.members) {
      whole.push_back(member.channel->error);
    }
    if (given_) {
      take_given_means(study_.baseline, group_, whole);
    }
    search.set_data(whole, mask_);
    bool any = false;
    for (const Evidence& evidence : outcome_.found) {
      if (evidence.cause->is_slow()) {
        search.reject(evidence);
      }
      any = any || evidence.cause->is_slow() || evidence.cause->as<SpectralLine>() != nullptr ||
            evidence.cause->as<SwitchingNoise>() != nullptr;
    }
    if (any) {
      search.fit_null();
    }
    outcome_.before = full_rate(search, whole, !given_);
    model.alone.noise = search.base();
    model.alone.noise.white = outcome_.before.model.white;
    model.alone.bias = search.null_fit().amplitude[0];
  }

  /// Takes noise that jumps between levels off the error, once; true if there was some.
  [[nodiscard]] bool take_switching_off(const SlowSearch& search) {
    const std::size_t before = outcome_.found.size();
    if (!std::exchange(switching_sought_, true)) {
      take_switching(full_rate(search, error_, false), error_, mask_, outcome_.found);
    }
    keep_best(outcome_.examined, {outcome_.found.begin() + static_cast<std::ptrdiff_t>(before), outcome_.found.end()});
    return outcome_.found.size() > before;
  }

  /// Sinusoids in the innovations, each with its cause.
  [[nodiscard]] static std::vector<Evidence> lines_in(const FullRate& data) {
    std::vector<Evidence> lines;
    for (const Cause& cause : cause_registry()) {
      if (const SpectralLine* const line = cause.as<SpectralLine>(); line != nullptr && !data.stopped()) {
        for (Evidence& evidence : line->examine(data)) {
          evidence.cause = &cause;
          lines.push_back(std::move(evidence));
        }
      }
    }
    return lines;
  }

  /// A fact of the file that can look like the cause has been found.
  [[nodiscard]] bool looks_like_fact(const Cause& cause) const {
    return std::any_of(outcome_.found.begin(), outcome_.found.end(), [&](const Evidence& found) {
      const auto& rivals = found.cause->rivals;
      return found.cause->as<FileFact>() != nullptr &&
             std::find(rivals.begin(), rivals.end(), cause.name) != rivals.end();
    });
  }

  /// Everything that needs the samples: each found effect is taken out before the next is sought.
  void search_full_rate() {
    take_colours({given_.has_value(), quantization_, lattice_step_, mask_}, outcome_);
    FullRate& data = outcome_.after;
    // Causes of the samples that are taken out one after the other. Chosen, not measured.
    constexpr int kMost = 2;
    for (int found = 0; !stopped(); ++found) {
      std::vector<Evidence> candidates = noise_candidates(data);
      const std::optional<Evidence> winner = choose(data, candidates);
      if (found == 0) {
        keep_best(outcome_.examined, candidates);
      }
      keep_last(outcome_.remaining, candidates, is_of_samples);
      if (!winner || found == kMost || whitened_) {
        break;
      }
      outcome_.found.push_back(*winner);
      take_out(data, *winner);
      if (winner->cause->as<DifferencedNoise>() != nullptr) {
        whiten_quantization(data, *winner);
        whitened_ = true;
      }
    }
  }

  /// Does it tell of the noise of single samples?
  [[nodiscard]] static bool is_of_samples(const Cause& cause) {
    return cause.as<NoiseTails>() != nullptr || cause.as<NoiseLevel>() != nullptr ||
           cause.as<DifferencedNoise>() != nullptr;
  }

  /// What can be said of the noise of single samples; tails only until some are found.
  [[nodiscard]] std::vector<Evidence> noise_candidates(const FullRate& data) const {
    const bool tails_known = std::any_of(outcome_.found.begin(), outcome_.found.end(), [](const Evidence& evidence) {
      return evidence.cause->as<NoiseTails>() != nullptr;
    });
    std::vector<const Cause*> asked;
    for (const Cause& cause : cause_registry()) {
      const bool tails = cause.as<NoiseTails>() != nullptr;
      const bool wanted = is_of_samples(cause);
      const bool lacking = cause.lacks != nullptr && !cause.lacks(study_, group_).empty();
      if (wanted && !(tails && tails_known) && !looks_like_fact(cause) && !lacking) {
        asked.push_back(&cause);
      }
    }
    std::vector<std::vector<Evidence>> found(asked.size());
    parallel_for(
        control_.threads, asked.size(), [&](std::size_t i) { found[i] = examine_of(*asked[i])(data); }, control_.stop);
    std::vector<Evidence> candidates;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      for (Evidence& evidence : found[i]) {
        evidence.cause = asked[i];
        candidates.push_back(std::move(evidence));
      }
    }
    return candidates;
  }

  /// Differenced noise that all recordings share is whitened with the model, so that the checks see what it leaves.
  void whiten_quantization(FullRate& data, const Evidence& found) const {
    if (found.members.size() != data.members()) {
      return;
    }
    FullRateOptions options;
    options.lattice_step = lattice_step_;
    options.quantization = quantization_ + found.shape;
    options.colour = data.colour;
    options.stop = control_.stop;
    const SlowModel model = data.model;
    data = look_at_full_rate(study_, group_, model, std::move(data.residual), mask_, options);
  }

  const Study& study_;
  const ChannelGroup& group_;
  std::size_t index_;
  const RunControl& control_;
  std::optional<SlowModel> given_;
  std::vector<Series> error_;
  std::vector<std::vector<unsigned char>> mask_;
  bool switching_sought_ = false;
  double lattice_step_ = 0.0;
  double given_white_ = 0.0;
  double quantization_ = 0.0;
  bool whitened_ = false;  ///< differenced noise that was found is part of the model that whitens
  GroupOutcome& outcome_;
};

}  // namespace

GroupOutcome search_group(const Study& study, const ChannelGroup& group, std::size_t index, const RunControl& control) {
  GroupOutcome outcome;
  GroupSearch(study, group, index, control, outcome).run();
  return outcome;
}

}  // namespace driftlab::investigate
