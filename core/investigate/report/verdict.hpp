#pragma once
/// The verdict of an investigation: one sentence that a person can act on.
///
/// It names the findings in the order of report/order.hpp, each cause once with its channels, and says how much of the
/// misfit they explain, how many failing checks they mend and what still fails. `Wrong`: an identified cause concerns
/// the recordings, the calibration or the noise. `Look`: all that was found is ambiguous or a matter of the format, or
/// something fails that no cause explains.
#include "core/investigate/report/report.hpp"

namespace driftlab::investigate {

/// Of a report that is complete but for its summary.
[[nodiscard]] Verdict verdict_of(const Report& report);

}  // namespace driftlab::investigate
