#pragma once
/// Profiles of the log likelihood of a drive's innovations along the knobs of causes. Internal to the explanation.
#include "core/navigate/drive/explain.hpp"
#include "core/navigate/drive/profile_parabola.hpp"

namespace driftlab::drive {

/// Profiles of several parameters from the same options.
struct ProfileEstimates {
  double at = 0.0;  ///< log likelihood of the options
  double mean_square = 1.0;
  std::vector<ProfileEstimate> knobs;
};

/// One thread may call it: what it asks of others it asks by itself.
class Profile {
 public:
  /// `drive` and `control` must outlive it. Only innovations of the folds that `used` marks count.
  Profile(const Drive& drive, std::array<bool, LogLikelihood::kFolds> used, const RunControl& control)
      : drive_(drive), used_(used), control_(control), stated_(options_of(drive.document)) {}

  /// Log likelihood of each trial; minus infinity for options that no filter can have.
  [[nodiscard]] std::vector<double> values(const std::vector<FilterOptions>& trials) const;
  /// One estimate for each knob, from the options.
  [[nodiscard]] ProfileEstimates estimates(const FilterOptions& options, const std::vector<const Knob*>& knobs) const;
  /// The factors of the white noise, gyroscope and accelerometer, at the top of the likelihood; steps begin at
  /// `first_factor`.
  [[nodiscard]] FilterOptions with_noise_fitted(FilterOptions options, double first_factor) const;
  /// The knobs at the top of the likelihood, one after the other.
  [[nodiscard]] FilterOptions refitted(FilterOptions options, const std::vector<const Knob*>& knobs, int sweeps) const;

  /// By how much options differ from the document in a knob, SI; Knob::most bounds it.
  [[nodiscard]] double change(const FilterOptions& options, const Knob& knob) const {
    return knob.value(options) - knob.value(stated_);
  }
  [[nodiscard]] static FilterOptions turned(const FilterOptions& options, const Knob& knob, double by);

 private:
  /// How far a knob may be turned from the options, down and up.
  [[nodiscard]] std::array<double, 2> range(const FilterOptions& options, const Knob& knob) const;
  /// By rising value of the knob.
  using Bracket = std::array<ProfilePoint, 3>;
  [[nodiscard]] std::vector<std::optional<LogLikelihood>> runs(const std::vector<FilterOptions>& trials) const;
  /// `blocks`: of the whole drive, those of other folds too.
  [[nodiscard]] ProfilePoint point(double at, const std::optional<LogLikelihood>& run, std::size_t blocks) const;
  /// The best share of a bracket, judged against none of it.
  void settle_share(const FilterOptions& options, const Knob& knob, const Bracket& bracket, std::size_t blocks,
                    ProfileEstimate& estimate) const;
  [[nodiscard]] Bracket stride(const FilterOptions& options, const Knob& knob, Bracket bracket,
                               std::size_t blocks) const;

  const Drive& drive_;
  std::array<bool, LogLikelihood::kFolds> used_;
  const RunControl& control_;
  FilterOptions stated_;  ///< by the document
  /// The newest runs, oldest first: a search asks again for the options that it stands at.
  struct Known {
    FilterOptions options;
    std::optional<LogLikelihood> run;
  };
  mutable std::vector<Known> known_;
};

}  // namespace driftlab::drive
