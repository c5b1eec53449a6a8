#pragma once
/// The innovations of a filter as evidence on the filter's options (spec/drives.md, section 6).
///
/// The log likelihood of a run is the sum over scalar innovations z of variance S of -(ln S + min(z^2/S, 9))/2; the cap
/// keeps a few wild ones from deciding. A filter's model is never quite right, so innovations are neither white nor of
/// their stated size, and what the sum says of a parameter's uncertainty is not its curvature alone: the sums are kept
/// apart for blocks of time, from which profile_parabola.hpp states it. Innovations of the first ten seconds are left
/// out.
#include "core/navigate/drive/evaluation.hpp"

namespace driftlab::drive {

/// Blocks of this length [s]: several times what an innovation remembers of an error of the model, and short enough
/// that a drive of ten minutes has thirty.
inline constexpr double kBlockLength = 20.0;
/// Stretches of so many blocks belong to the two folds of a held-out study in turn.
inline constexpr std::size_t kFoldBlocks = 5;

[[nodiscard]] std::size_t block_at(double time_s);
[[nodiscard]] std::size_t fold_of_block(std::size_t block);

/// Sums of a run, apart for blocks of the innovations' moments.
struct LogLikelihood {
  static constexpr std::size_t kFolds = 2;
  struct Sums {
    double log_likelihood = 0.0;
    double squares = 0.0;  ///< capped normalised squares
    double count = 0.0;
  };
  std::vector<Sums> blocks;  ///< by block_at

  /// Of the folds that `used` marks.
  [[nodiscard]] double over(const std::array<bool, kFolds>& used) const;
  [[nodiscard]] double mean_square(const std::array<bool, kFolds>& used) const;
};

/// The fold in which an outage lies whole; nothing for one across a border.
[[nodiscard]] std::optional<std::size_t> fold_of(const Outage& outage);

/// Runs the filter over all fixes. Errors: those of PreparedDrive::make.
[[nodiscard]] Result<LogLikelihood> log_likelihood(const Drive& drive, const FilterOptions& options);

/// The receiver's velocities against its positions, without the unit: displacement minus integrated velocity, regressed
/// on the change of velocity. Both along and across the way give the delay. Its error is that of profile_parabola.hpp
/// over blocks of the steps. Noise s of the velocities makes changes look larger than they are and the delay smaller by
/// 2 s^2 over the mean square of the changes (Fuller, Measurement Error Models, 1987, section 1.1), which the error
/// does not hold: 4 % at 5 cm/s and 4 Hz in a town.
struct FixDelay {
  double delay_s = 0.0;  ///< by how much the velocity is older than the position
  double se_s = 0.0;
  double along_s = 0.0, across_s = 0.0;
  double score = 0.0;
  std::size_t steps = 0;
};
/// Nothing where too few fixes have a velocity that changes.
[[nodiscard]] std::optional<FixDelay> delay_from_fixes(const std::vector<Fix>& fixes);

/// The odometer against the fixes, without the unit: stretches in which it reads otherwise than its usual ratio to the
/// speed over ground says, by more than 5 robust standard deviations and 0.5 m/s for 0.3 s and more. A scale factor is
/// the same everywhere and is no slip.
struct WheelSlips {
  double scale = 0.0;                          ///< odometer = (1 + scale) speed, in the median
  double sd_m_s = 0.0;                         ///< of the odometer about that, robust
  std::vector<std::array<double, 2>> slips{};  ///< from, to [s]
  [[nodiscard]] double seconds() const;
};
/// Nothing where fewer than 50 readings lie between fixes with a velocity above 3 m/s.
[[nodiscard]] std::optional<WheelSlips> slips_of(const Drive& drive, double velocity_latency_s);

}  // namespace driftlab::drive
