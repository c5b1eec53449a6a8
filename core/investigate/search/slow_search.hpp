#pragma once
/// The search for mean effects and slow noise, which can explain the same slow misfit of a channel group.
///
/// A wrong base model hides effects: fitted to a recording with a step, it acquires a random walk that "explains" the
/// step. Every effect is therefore (1) screened under several base models (each order fitted to all recordings, and
/// fits to single recordings in which the effect may be absent), and (2) the most promising ones are fitted again
/// jointly with the base from several starting points. Scores are comparable: twice the joint log likelihood minus the
/// costs of base and effect, minus the same for the best base alone. The base may be white noise + up to two
/// Gauss-Markov processes + a random walk; each parameter of a process costs 3.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "core/signal/progress.hpp"

#include <optional>
#include <span>
#include <vector>

namespace driftlab::investigate {

/// What a process of the base costs, in twice the log likelihood.
[[nodiscard]] inline double cost_of(const ProcessKind& kind) {
  return 3.0 * static_cast<double>(kind.parameters.size());
}

/// A mean effect as regressors on the blocks.
struct Regressor {
  const Cause* cause = nullptr;  ///< null: the constant bias
  std::vector<std::size_t> members;
  double shape = 0.0;
  int columns = 1;
};

/// Regressor columns of an effect in a scope.
[[nodiscard]] inline int width_of(const Cause& cause, const std::vector<std::size_t>& members) {
  return cause.as<MeanEffect>()->columns * (cause.as<MeanEffect>()->free_phase ? static_cast<int>(members.size()) : 1);
}

/// What the search knows about one group between its rounds.
class SlowSearch {
 public:
  /// `given`: the baseline's slow model where it is given. Of `control` it uses the threads, to which it hands the
  /// joint fits, and the stop token: once stop is requested everything ends soon, with results of no meaning.
  SlowSearch(const Study& study, const ChannelGroup& group, std::optional<SlowModel> given,
             const RunControl& control = {});

  /// (Re)reads the error of the group: `error[r]` over the grid of member r; `mask[r]` removes samples.
  void set_data(const std::vector<Series>& error, const std::vector<std::vector<unsigned char>>& mask);

  /// Level of the white part per recording relative to the common one (nuisance), estimated at higher frequencies.
  void set_white_scale(std::vector<double> scale);
  [[nodiscard]] bool has_white_scale() const { return !white_scale_.empty(); }

  /// The best base alone (with what has been accepted): also the start of the next `examine`.
  const SlowFit& fit_null();

  /// Every mean effect and slow process of the registry that can be examined, each in its best scope and shape, after
  /// the joint fit; unordered.
  [[nodiscard]] std::vector<Evidence> examine();

  /// Makes a found effect part of the null.
  void accept(const Evidence& evidence);

  /// Takes an accepted effect out of the null again, which is to be fitted after that.
  void reject(const Evidence& evidence);

  /// Parameters with intervals of an accepted effect under the present null.
  void describe(Evidence& evidence) const;
  /// The held-out gain alone.
  void hold_out(Evidence& evidence) const;

  [[nodiscard]] const SlowFit& null_fit() const { return null_; }
  /// The null's model without the accepted slow processes.
  [[nodiscard]] SlowModel base() const;
  /// Error minus the accepted mean effects and the bias over the analysed part, at full rate.
  [[nodiscard]] std::vector<Series> residuals(const std::vector<Series>& error) const;
  [[nodiscard]] const BlockSeries& series() const { return series_; }
  /// Amplitude columns of an accepted effect in the null's fit: index of its first regressor.
  [[nodiscard]] std::optional<std::size_t> regressor_of(const Evidence& evidence) const;
  /// Penalised twice-log-likelihood of the null.
  [[nodiscard]] double null_score() const { return null_score_; }

 private:
  /// A candidate of the screening: cause, scope, shape, and the base at which it did best.
  struct Screened {
    const Cause* cause = nullptr;
    std::vector<std::size_t> members;
    double shape = 0.0;
    double penalty = 0.0;
    double score = -1e300;  ///< penalised twice-log-likelihood at the screening base
    SlowModel base;
  };
  struct Templates {
    const Cause* cause = nullptr;
    double shape = 0.0;
    std::vector<std::vector<std::vector<double>>> blocks;  ///< column, member, block; empty member: no input
  };
  void build_templates();
  [[nodiscard]] const Templates* find_templates(const Cause* cause, double shape) const;
  [[nodiscard]] Templates make_templates(const Cause* cause, double shape) const;
  [[nodiscard]] BlockColumns columns_with(const std::vector<Regressor>& regressors) const;
  [[nodiscard]] std::vector<SlowModel> starting_orders(const BlockColumns& columns) const;
  [[nodiscard]] std::vector<SlowModel> screening_bases() const;
  void screen(const SlowModel& base, double base_score, std::vector<Screened>& best) const;
  void screen_steps(const SlowModel& base, double base_score, std::vector<Screened>& best) const;
  /// What a step costs where the choice of its time costs `search_cost`.
  [[nodiscard]] double step_penalty(const MeanEffect& effect, double search_cost) const;
  [[nodiscard]] Evidence fit_jointly(const Screened& candidate) const;
  /// Largest value of the last regressor's effect over the largest reference rate.
  [[nodiscard]] double share_of_rate(const std::vector<Regressor>& regressors, const SlowFit& fit) const;
  [[nodiscard]] std::vector<Evidence> examine_slow() const;
  /// Whether a process of the cause is in the null already, throughout the scope.
  [[nodiscard]] bool has_extra(const Cause& cause, const std::vector<std::size_t>& scope) const;
  /// Where a fit of one more process starts: a share of the block means' white variance, or of what the process has
  /// gathered by the end of the longest record where its level is per root second.
  [[nodiscard]] double first_level(const ProcessKind& kind, double share, double gathered, double level) const;
  [[nodiscard]] SlowFit fit_extra(const ProcessKind& kind, const std::vector<std::size_t>& scope, const SlowModel& base,
                                  const BlockColumns& columns) const;
  /// The same; where the levels of the recordings are a nuisance, once with them and once without, for what seems a
  /// level may be the process itself. The better of the two, each free level at its cost.
  [[nodiscard]] SlowFit fit_extra_freely(const ProcessKind& kind, const std::vector<std::size_t>& scope,
                                         const SlowModel& base, const BlockColumns& columns) const;
  [[nodiscard]] double cost(const SlowModel& model) const;
  [[nodiscard]] SlowFreedom freedom() const;
  void refine_shape(Regressor& regressor, const SlowModel& model) const;
  void describe_mean(Evidence& evidence) const;
  void describe_slow(Evidence& evidence) const;
  void hold_out_mean(Evidence& evidence) const;
  /// Log likelihood of each fold at amplitudes fitted to the other, under a noise model as it stands.
  [[nodiscard]] double score_across_folds(const BlockColumns& columns, const SlowModel& noise) const;
  /// The noise that describes the recordings best without the effect, which it may imitate.
  [[nodiscard]] SlowModel noise_without(const BlockColumns& columns) const;
  void hold_out_slow(Evidence& evidence) const;
  void place_step(Evidence& evidence) const;
  [[nodiscard]] SlowModel widest_base(const BlockColumns& columns) const;

  const Study& study_;
  const ChannelGroup& group_;
  std::optional<SlowModel> given_;
  ThreadShare threads_;
  std::stop_token stop_;
  BlockSeries series_;
  std::vector<Series> error_;
  std::vector<std::vector<unsigned char>> mask_;
  std::vector<double> white_scale_;
  std::vector<Templates> templates_;
  std::vector<Regressor> accepted_;
  std::vector<SlowComponent> extra_;  ///< accepted slow processes
  std::vector<const Cause*> extra_cause_;
  SlowFit null_;
  std::vector<SlowFit> orders_;
  double null_score_ = 0.0;
  double exact_score_ = 0.0;    ///< the same without the nuisance of levels
  std::size_t base_count_ = 0;  ///< components of null_ that belong to the base, before the extras
};

}  // namespace driftlab::investigate
