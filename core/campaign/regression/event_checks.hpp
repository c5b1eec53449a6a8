#pragma once
/// Checks of facts other than noise levels: the candidate's sessions against all baseline sessions (spec/regression.md,
/// section 7).
///
/// Saturation, missing, frozen and repeated samples, jitter of the time stamps, resolution, sampling rate and
/// identified causes are compared as facts. Of repeated samples those count that rounding does not explain
/// (held_share.hpp): as the specification has it, by their plain share, 25 of 30 comparisons of an unchanged ADIS16405
/// failed. A coarser step counts where the noise shows it. Gross errors are counted (gross_errors.hpp); their p share
/// the level of the event family by Holm. A result counts flagged samples; where it counts bursts, those within a
/// second of each other are one.
#include "core/campaign/regression/sessions.hpp"

#include <string>
#include <vector>

namespace driftlab::regression {

enum class CheckVerdict { Ok, Note, Fail };
[[nodiscard]] std::string_view name_of(CheckVerdict verdict);

struct EventCheck {
  std::string check;  ///< saturation, missing, frozen, repeated, timestamps, resolution, contamination, findings, rate,
                      ///< bias (bias_check.hpp), scale_factor (scale_check.hpp), time_base (time_base.hpp)
  CheckVerdict verdict = CheckVerdict::Ok;
  std::string sentence;               ///< empty where it is fine
  std::vector<std::string> sessions;  ///< the candidate's that show it
  std::optional<double> p;            ///< of a check that is a test
};

/// One entry per check, in the order above. `event_alpha` is the level of the family of tests in this look.
[[nodiscard]] std::vector<EventCheck> check_events(const std::vector<PowerUp>& baseline,
                                                   const std::vector<PowerUp>& candidate, double event_alpha,
                                                   const EventLimits& limits = {});

/// `gyroscope z`, `accelerometer x, 9 deg/s about z`: the name of a channel under a condition; empty for a channel
/// without a stated quantity and axis, which is not compared.
[[nodiscard]] std::string unit_name(const ComparedRecording& recording, const ReportedChannel& channel);

}  // namespace driftlab::regression
