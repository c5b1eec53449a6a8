#pragma once
/// The daemon's log: one JSON object per line on stderr, written by a background thread that never makes a request
/// wait.
#include "schema/json/json.hpp"

#include <string_view>

namespace driftlab::server {

/// Starts the log. Level: debug, info, warning, error. Call once, before threads start.
void start_log(std::string_view level);
/// Writes what is pending and ends the log.
void stop_log();

/// One event. `fields` is an object; `time`, `level` and `event` are added.
void log_debug(std::string_view event, const Json& fields = Json::object());
void log_info(std::string_view event, const Json& fields = Json::object());
void log_warning(std::string_view event, const Json& fields = Json::object());
void log_error(std::string_view event, const Json& fields = Json::object());

}  // namespace driftlab::server
