#pragma once
/// The fits of a recording's newest characterisation.
#include "server/store/store.hpp"

#include <string>
#include <vector>

namespace driftlab::server {

/// The fits of the newest job that characterised the recording; empty where none has.
[[nodiscard]] Result<std::vector<Fit>> newest_fits(Store& store, const std::string& recording_id);

/// What is refused where there are none, and where none is of the channel.
[[nodiscard]] Error not_characterised(const std::string& recording_id);
[[nodiscard]] Error no_channel(const std::string& recording_id, const std::string& name);

}  // namespace driftlab::server
