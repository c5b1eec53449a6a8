#pragma once
/// The job kind `investigate`: a study in, what its baseline simulation gets wrong out, and the extended model as a
/// stored revision.
///
/// `inputs`: {"study": "stu_..."}. `parameters`: {"baseline": {...}} in place of the study's own, optional. A baseline
/// that names a stored model (`{"kind": "model", "id": "mod_..."}`) makes that the parent of the revision; any other is
/// stored as a model first.
#include "server/jobs/job_kind.hpp"

#include <memory>

namespace driftlab::server {

[[nodiscard]] std::unique_ptr<JobKind> make_investigate_kind();

}  // namespace driftlab::server
