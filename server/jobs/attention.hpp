#pragma once
/// What of a job's results a person must read: the verdicts that are not fine. A job kind notes them as it makes its
/// rows.
#include "server/store/rows.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// Adds a verdict to `results.attention` unless its level is `fine`. `about`: the device, the recording and the channel
/// of which it speaks, each empty where it speaks of none.
void note_attention(Attention about, std::string_view level, const std::string& verdict, JobResults& results);

}  // namespace driftlab::server
