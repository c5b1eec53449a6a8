#pragma once
/// A sensor axis at a glance: the summary that a list of devices shows for it.
///
/// One result represents the axis, one recorded at rest if there is any. The summary gives the noise density of rate or
/// acceleration, the model that is ranked first, and whether that model fits; the verdict of the channel says more
/// (core/campaign/verdict.hpp).
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

/// `fit`: the best of a channel. `density`: the coefficient N of the channel at low frequencies, for any model; nothing
/// for an older stored result that lacks it, and the N of the model's white noise is then used.
[[nodiscard]] AxisGlance glance_of(const ReportedFit& fit, const std::optional<ReportedValue>& density);

}  // namespace driftlab
