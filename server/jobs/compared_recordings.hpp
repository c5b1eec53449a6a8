#pragma once
/// Stored recordings as a regression run compares them (core/campaign/regression/recordings.hpp).
#include "core/campaign/regression/recordings.hpp"
#include "schema/json/json.hpp"
#include "server/store/store.hpp"

#include <map>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

namespace driftlab::server {

/// The latest results of all sensor axes of a device, by recording.
using ResultsByRecording = std::map<std::string, std::vector<ChannelResult>>;

/// `only`: recordings whose results are kept; empty: all of the device, of which there may be very many. Errors:
/// Cancelled; those of the store.
[[nodiscard]] Result<ResultsByRecording> results_by_recording(Store& store, const std::string& device_id,
                                                              const std::stop_token& stop = {},
                                                              const std::set<std::string>& only = {});

/// The recordings of a pinned arm (pinned_arms.hpp). `stop` is polled before each. Errors: Cancelled, also where a
/// recording has newer results than the pinned ones; Internal, for a row that driftlab has not written.
[[nodiscard]] Result<regression::Recordings> compared_recordings(Store& store, const Json& arm,
                                                                 const ResultsByRecording& results,
                                                                 const std::stop_token& stop);

}  // namespace driftlab::server
