#pragma once
/// What stored investigations found in the recordings of a device: causes that are `identified`, for regression runs
/// (spec/regression.md, section 7).
#include "server/store/store.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace driftlab::server {

struct RecordingCauses {
  std::int64_t revision = 1;         ///< of the recording that was investigated
  std::set<std::string> identified;  ///< names of causes; empty: it was investigated, and nothing is certain
};

/// By recording, of the newest investigation that a recording was part of. One that is absent was never investigated.
using CausesByRecording = std::map<std::string, RecordingCauses>;

/// Errors: those of the store.
[[nodiscard]] Result<CausesByRecording> identified_causes(Store& store, const std::string& device_id);

}  // namespace driftlab::server
