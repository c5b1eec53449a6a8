#pragma once
/// A sensor axis at a glance: what a list of devices shows of it, before anybody opens a result.
///
/// Of all results of an axis one stands for it, that at rest where there is one. It says the noise density of rate or
/// acceleration, which model is ranked first, and whether that model fits; a longer answer is the verdict of the
/// channel (core/campaign/verdict.hpp).
#include "core/campaign/reported_channel.hpp"
#include "core/campaign/verdict.hpp"

#include <optional>
#include <string>

namespace driftlab {

struct AxisGlance {
  std::optional<bool> fits;  ///< whether the J test accepts the model at 1 %; nothing where too few scales test it
  VerdictLevel level = VerdictLevel::Look;
  std::string reason;     ///< why it is to be looked at; empty where it is fine
  ReportedValue density;  ///< N, in the unit of the field; without a value where there is none
};

/// `fit`: the best of a channel. `density`: the N that the channel's Allan deviation has at low frequencies, whatever
/// the model; nothing where a result was stored before it was kept, and then the model's own white noise stands for it.
[[nodiscard]] AxisGlance glance_of(const ReportedFit& fit, const std::optional<ReportedValue>& density);

/// A result that may stand for its axis.
struct AxisCandidate {
  bool at_rest = false;
  VerdictLevel level = VerdictLevel::Look;  ///< of its glance
};

/// Whether `candidate` stands for the axis rather than `shown`: the one at rest does, and of two at rest the one to be
/// looked at, for a glance must not pass over it. Of two in motion the one seen first stays.
[[nodiscard]] bool tells_more(const AxisCandidate& candidate, const AxisCandidate& shown);

}  // namespace driftlab
