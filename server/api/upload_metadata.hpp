#pragma once
/// What an upload says about its file, from the query string or from the `metadata` part.
#include "core/signal/recording.hpp"
#include "schema/json/recording_tags.hpp"
#include "server/http/message.hpp"
#include "server/store/rows.hpp"

namespace driftlab::server {

struct UploadMetadata {
  Device device;  ///< only the user's members are set
  RecordingSpec spec;
  RecordingTags tags;
  std::string file_name = {};  ///< as the sender calls the file; may be empty
};

/// What a sender calls a file, as it is kept and shown: without folders and control characters, 255 bytes at most;
/// empty where that leaves nothing or it is no UTF-8.
[[nodiscard]] std::string shown_file_name(std::string_view name);

/// A fault for each label, session and time beyond the budgets, which `pointer` leads to.
void limit_tags(const RecordingTags& tags, const Budgets& budgets, const std::string& pointer, Faults& faults);

/// A fault for each name of a specification beyond the budget name_bytes, which `pointer` leads to: its id, its stream,
/// its calibration, its columns. Of a change, only what its document `given` states.
void limit_names(const RecordingSpec& spec, const Budgets& budgets, const std::string& pointer, Faults& faults,
                 const Json* given = nullptr);

/// `?device=…&condition=…&rate_hz=…&columns=…&stream=…&id=…&trim_start_s=…&trim_end_s=…`
/// and `&labels=firmware=1.5.0&session=…&recorded_at=…&file_name=…`; the condition in its compact form
/// (`constant_rate:z:9:deg/s`) or its parts as `condition`, `axis`, `value`, `unit`, `direction`.
/// Errors: those of core/signal, with field "parameter".
[[nodiscard]] Result<UploadMetadata> metadata_from_query(const Request& request);

/// One recording of spec/study.md as JSON, which may also hold `device` (a name, or the `device` object of a study)
/// where the query has none.
[[nodiscard]] Result<UploadMetadata> metadata_from_json(std::string_view text, const Request& request);

}  // namespace driftlab::server
