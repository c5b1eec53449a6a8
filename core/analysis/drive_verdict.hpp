#pragma once
/// What the answer to a question about a recorded drive comes to, for whoever reads no more than one sentence
/// (core/campaign/verdict.hpp).
#include "core/analysis/drive.hpp"
#include "core/campaign/verdict.hpp"

namespace driftlab {

/// The sentence is the first of `sentence_of`, the details are the others. A reader must look where the filter is too
/// sure of itself: where its 95 % ellipse holds fewer errors than it may (outage_verdict.hpp) in outages of some
/// length; of several models where that is so of each, of an explanation where it is so of the model that is explained.
[[nodiscard]] Verdict verdict_of(const DriveAnswer& answer);

}  // namespace driftlab
