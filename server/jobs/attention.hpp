#pragma once
/// What of a job's results a person must read: the verdicts that are not fine.
#include "server/store/rows.hpp"

namespace driftlab::server {

/// Fills `attention` and `looked_at` from the rest: of each recording that was characterised the channel whose verdict
/// is gravest, of any other result its own `summary`. O(length of the documents) time.
void note_attention(JobResults& results);

}  // namespace driftlab::server
