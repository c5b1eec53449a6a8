#pragma once
/// Profiles of the log likelihood of a drive's innovations along the knobs of causes. Internal to the explanation.
#include "core/navigate/drive/explain.hpp"

#include <array>
#include <optional>
#include <vector>

namespace driftlab::drive {

/// Where a profile has its top, relative to the present value, SI.
struct ProfileEstimate {
  bool sound = false;  ///< the profile is concave there
  double value = 0.0;
  double se = 0.0;
  double scatter = 0.0;  ///< the part of `se` that innovations leave open, without what the knob adds to it
  double top = 0.0;      ///< log likelihood
  double score = 0.0;
  [[nodiscard]] double gain_to(double at) const { return sound ? top - at : 0.0; }
};

/// One thread may ask it: it remembers what it has run.
class Profile {
 public:
  /// `drive` and `control` must outlive it. Only innovations of the folds that `used` marks count.
  Profile(const Drive& drive, std::array<bool, LogLikelihood::kFolds> used, const RunControl& control)
      : drive_(drive), used_(used), control_(control), stated_(options_of(drive.document)) {}

  /// Log likelihood of each trial; minus infinity for options that no filter can have.
  [[nodiscard]] std::vector<double> values(const std::vector<FilterOptions>& trials) const;
  /// 3 c of the options.
  [[nodiscard]] double scale(const FilterOptions& options) const;
  /// One estimate for each knob, from the options whose log likelihood is `at`.
  [[nodiscard]] std::vector<ProfileEstimate> estimates(const FilterOptions& options, double at,
                                                       const std::vector<const Knob*>& knobs, double scale) const;
  /// The factors of the white noise, gyroscope and accelerometer, at the top of the likelihood, one after the other;
  /// steps begin at `first_factor`.
  [[nodiscard]] FilterOptions with_noise_fitted(FilterOptions options, double first_factor) const;
  /// The knobs at the top of the likelihood, one after the other.
  [[nodiscard]] FilterOptions refitted(FilterOptions options, const std::vector<const Knob*>& knobs, int sweeps) const;

  /// By how much options differ from the document in a knob, SI; Knob::most bounds it.
  [[nodiscard]] double change(const FilterOptions& options, const Knob& knob) const {
    return knob.value(options) - knob.value(stated_);
  }
  /// How far a knob may be turned from the options: down, up.
  [[nodiscard]] std::array<double, 2> range(const FilterOptions& options, const Knob& knob) const;
  [[nodiscard]] static FilterOptions turned(const FilterOptions& options, const Knob& knob, double by);

 private:
  struct Bracket {
    double low, middle, high;
    double low_value, middle_value, high_value;
  };
  /// One of the two factors at the top: steps by `factor` and its roots while the likelihood rises, then the vertex of
  /// the parabola in the level's logarithm.
  [[nodiscard]] FilterOptions with_level_fitted(FilterOptions options, bool gyroscope, double factor) const;
  /// The likelihood of each trial; nothing for options that no filter can have.
  [[nodiscard]] std::vector<std::optional<LogLikelihood>> runs(const std::vector<FilterOptions>& trials) const;
  [[nodiscard]] Bracket stride(const FilterOptions& options, const Knob& knob, Bracket bracket) const;
  /// Value, top and error of a share, whose profile is no parabola and may have its top at an end.
  void settle_share(const FilterOptions& options, const Knob& knob, const Bracket& bracket, double scale,
                    ProfileEstimate& estimate) const;
  /// Of a share whose log likelihood is `gain` above that of none: what is as many standard errors from none as a
  /// parabola with that gain, x^2/(2 se^2) = gain/scale.
  [[nodiscard]] static double se_against_none(double share, double gain, double scale);
  [[nodiscard]] static ProfileEstimate parabola(const Bracket& bracket, double scale);

  const Drive& drive_;
  std::array<bool, LogLikelihood::kFolds> used_;
  const RunControl& control_;
  FilterOptions stated_;  ///< by the document
  struct Run {
    FilterOptions options;
    std::optional<LogLikelihood> likelihood;
  };
  /// The newest runs, oldest first: a search asks again for the options that it stands at.
  mutable std::vector<Run> known_;
};

}  // namespace driftlab::drive
