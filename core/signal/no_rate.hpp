#pragma once
/// The refusal of a recording whose samples lie nowhere in time, said alike by every use of a recording.
#include "core/signal/result.hpp"

namespace driftlab {

/// Of a recording with neither a time column nor a stated rate.
[[nodiscard]] inline tl::unexpected<Error> neither_time_nor_rate() {
  return fail(
      ErrorCode::InconsistentSampling,
      "There is no time column and no stated rate: give rate_hz, or name the time column (columns NAME=time:s).",
      {{"parameter", "rate_hz"}});
}

}  // namespace driftlab
