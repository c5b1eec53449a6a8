#pragma once
/// The checks that refuse a regression request before its recordings are compared. Internal to
/// core/campaign/regression.
#include "core/campaign/regression/recordings.hpp"
#include "core/signal/result.hpp"

namespace driftlab::regression {

/// Errors: InvalidArgument, for an arm without recordings (field "arm"), a recording that is in both arms, and the same
/// samples under two names (field "recording").
[[nodiscard]] Status check_arms(const Request& request);

}  // namespace driftlab::regression
