#pragma once
/// What happens in the daemon, as its log, its metrics and its bad states keep it.
#include "schema/json/json.hpp"
#include "server/http/server.hpp"
#include "server/observe/metrics.hpp"
#include "server/store/bad_states.hpp"

#include <string_view>

namespace driftlab::server {

/// A state that begins or ends, into the log.
void note_state(const StandingState& state, bool begins);

/// What failed in the daemon itself goes into the log whole, for answers leave out where its files are; where the disk
/// failed that is a bad state. `where`: what it belongs to.
void note_failure(BadStates& states, const Error& error, const Json& where);

/// An exception that a thread of the daemon survived (server/store/guarded_round.hpp), into the log.
void note_escape(std::string_view where, std::string_view what);

/// A request that was answered.
void note_request(Metrics& metrics, BadStates& states, const AccessRecord& record);

}  // namespace driftlab::server
