#pragma once
/// From bytes on disk to a recording: recognised, decoded once, checked against their metadata and recorded. Every way
/// in ends here: an upload in one request, a resumable one, a live recording. A failure before the row is written
/// leaves nothing behind.
#include "server/api/api.hpp"
#include "server/api/upload_metadata.hpp"

namespace driftlab::server {

/// `blob` is sealed and not empty; `upload` is the id of the resumable one that it came by, which no longer counts
/// beside it. 201 with the recording, or 200 with the one that exists already. Errors: forbidden where the caller may
/// not use the device; those of require_quota_of_token, of decoding and of the store.
[[nodiscard]] Result<Response> record_blob(ApiContext& context, IncomingBlob& blob, const UploadMetadata& metadata,
                                           std::string_view upload = "");

/// Refuses `more` bytes of this SHA-256 beyond what the token of this thread's caller may have: what it uploaded, and
/// what it said of the resumable uploads under way, without `upload`. Error: DiskFull naming the budget.
[[nodiscard]] Status require_quota_of_token(ApiContext& context, std::string_view sha256, std::uint64_t more,
                                            std::string_view upload = "");

/// Metadata and samples must fit together before anything is kept. What the survey finds as JSON text; of a drive's
/// recording none of whose columns is said to be a sensor, that there is nothing to characterise. A device that is not
/// stored yet has no id.
[[nodiscard]] Result<std::string> surveyed_quality(ApiContext& context, const std::filesystem::path& columns,
                                                   const RecordingSpec& spec, const Device& device);

/// Refuses while less is free than the budget least_free_bytes, so that the database can still write. Error: DiskFull.
[[nodiscard]] Status require_space(const ApiContext& context);

/// The query parameters that say what a file is, as POST /v1/recordings takes them.
[[nodiscard]] std::vector<std::string_view> metadata_parameters();

}  // namespace driftlab::server
