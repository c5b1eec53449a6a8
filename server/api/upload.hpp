#pragma once
/// POST /v1/recordings: bytes stream to disk while they are hashed; then they are recognised, decoded once, checked
/// against their metadata and recorded. Whatever goes wrong before the row is written leaves nothing behind.
#include "server/api/api.hpp"

namespace driftlab::server {

/// Checks everything that is known before the body (query, headers, disk space) and starts an upload.
[[nodiscard]] Result<std::unique_ptr<UploadSession>> begin_upload(ApiContext& context, const Request& request);

}  // namespace driftlab::server
