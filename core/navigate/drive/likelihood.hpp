#pragma once
/// The innovations of a filter as evidence on the filter's options (spec/drives.md, section 6).
///
/// The log likelihood of a run is the sum over scalar innovations z of variance S of -(ln S + min(z^2/S, 9))/2; the cap
/// keeps a few wild ones from deciding. A filter's model is never quite right, so innovations are neither white nor of
/// their stated size: with c the mean capped normalised square, uncertainties are those of a log likelihood divided by
/// 3 c. Innovations of the first ten seconds are left out.
#include "core/navigate/drive/evaluation.hpp"

namespace driftlab::drive {

/// Sums of a run, apart for the folds of a held-out study.
struct LogLikelihood {
  static constexpr std::size_t kFolds = 2;
  std::array<double, kFolds> sum{};      ///< by fold of the innovation's moment
  std::array<double, kFolds> squares{};  ///< capped normalised squares
  std::array<double, kFolds> count{};

  [[nodiscard]] double total() const { return sum[0] + sum[1]; }
  /// Of the folds that `used` marks.
  [[nodiscard]] double over(const std::array<bool, kFolds>& used) const;
  [[nodiscard]] double mean_square(const std::array<bool, kFolds>& used) const;
};

/// Stretches of this length [s] belong to the two folds in turn.
inline constexpr double kFoldLength = 100.0;
[[nodiscard]] std::size_t fold_at(double time_s);
/// The fold in which an outage lies whole; nothing for one across a border.
[[nodiscard]] std::optional<std::size_t> fold_of(const Outage& outage);

/// Runs the filter over all fixes. Errors: those of PreparedDrive::make.
[[nodiscard]] Result<LogLikelihood> log_likelihood(const Drive& drive, const FilterOptions& options);

/// The receiver's velocities against its positions, without the unit: displacement minus integrated velocity, regressed
/// on the change of velocity. Both along and across the way give the delay. The change from the fix before to the fix
/// after the two is the instrument: it goes with the change between them and has none of their noise, which would make
/// the delay too small (by 4 % where velocities of 4 Hz have 5 cm/s).
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
