#pragma once
/// A channel of a characterisation document at a glance: what a list of devices shows of it, as it is kept and served.
#include "schema/json/json.hpp"
#include "server/store/rows.hpp"

namespace driftlab::server {

/// {"model", "N", "fits", "level", "reason"} of the best fit of a member of `channels`, with the density N of its
/// channel; null for a channel without fits. Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<Glance> told_glance(const Json& channel);

}  // namespace driftlab::server
