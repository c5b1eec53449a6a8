#pragma once
/// The job kind `characterise`: recordings in, variances, Allan coefficients and ranked fits of each sensor channel
/// out.
///
/// `inputs`: {"recordings": ["rec_..."]}, 1 to 100 of them. `parameters`: {"models": ["WN", ...], "seed": 1}, both
/// optional.
#include "server/jobs/job_kind.hpp"

#include <memory>

namespace driftlab::server {

[[nodiscard]] std::unique_ptr<JobKind> make_characterise_kind();

}  // namespace driftlab::server
