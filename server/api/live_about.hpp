#pragma once
/// What a live recording keeps about itself beside its samples: how they are to be read, and for whom.
#include "server/api/upload_metadata.hpp"
#include "server/http/message.hpp"
#include "server/store/live_recordings.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

struct LiveAbout {
  UploadMetadata metadata;
  std::vector<std::string> columns;  ///< in the order of the values
};

/// `about_json` of what begins now. `given` is the document it was asked for with, a column for each of `columns`.
[[nodiscard]] std::string live_about_text(const Json& given, const std::string& device,
                                          const std::vector<std::string>& columns, UtcMicros now,
                                          const Principal& principal);

/// What was within the budgets when it began is so to its end. Errors: those of metadata_from_json.
[[nodiscard]] Result<LiveAbout> about_of(const LiveRecording& recording);

[[nodiscard]] Unit unit_of(const LiveAbout& about, const std::string& column);

/// Who began it, for whom everything is done with it; nothing where an earlier release began it and did not say.
[[nodiscard]] std::optional<Principal> principal_of(const LiveRecording& recording);

}  // namespace driftlab::server
