#pragma once
/// A channel of a characterisation document at a glance: what a list of devices shows of it, as it is kept and served.
#include "core/campaign/verdict.hpp"
#include "schema/json/json.hpp"

namespace driftlab::server {

/// `document`: {"model", "N", "fits", "level", "reason"}; null for a channel without fits.
struct ToldGlance {
  Json document;
  VerdictLevel level = VerdictLevel::Look;
};

/// Of the best fit of a member of `channels`, and the density N of its channel. Error: Internal, for a document that
/// driftlab has not written.
[[nodiscard]] Result<ToldGlance> told_glance(const Json& channel);

}  // namespace driftlab::server
