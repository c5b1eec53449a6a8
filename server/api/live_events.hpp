#pragma once
/// What a live recording says so far, followed while it grows.
#include "server/api/live_about.hpp"
#include "server/http/router.hpp"

#include <memory>
#include <string>

namespace driftlab::server {

/// An event `growth` of one channel every two seconds at most, and less often where that takes long; `finished` at the
/// end. `recordings` must outlive it.
[[nodiscard]] std::unique_ptr<EventSource> growth_events(const LiveRecordings& recordings, std::string id,
                                                         LiveAbout about, std::string channel);

}  // namespace driftlab::server
