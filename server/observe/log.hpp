#pragma once
/// The daemon's log: one JSON object per line on stderr or in a file, written by a background thread that never makes a
/// request wait: where the reader is slower than the daemon, the oldest lines are dropped and counted.
#include "core/signal/result.hpp"
#include "schema/json/json.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace driftlab::server {

/// Starts the log. Level: debug, info, warning, error. `file` empty: standard error. Call once, before threads start.
/// Error: Io, where the file cannot be opened.
[[nodiscard]] Status start_log(std::string_view level, const std::string& file);
/// Opens the log file again after it was moved away; does nothing without a file. If it cannot be opened, the log
/// continues in the old file. Error: Io.
[[nodiscard]] Status reopen_log();
/// Lines dropped since the start.
[[nodiscard]] std::uint64_t dropped_log_lines();
/// Writes what is pending and ends the log.
void stop_log();

/// The members of a line that is written for every request: text made at once, where a document of JSON would cost more
/// than what it tells of. Names are plain words.
class LogFields {
 public:
  LogFields& text(std::string_view name, std::string_view value);
  LogFields& text_or_null(std::string_view name, std::string_view value);  ///< null where it is empty
  LogFields& count(std::string_view name, std::uint64_t value);
  LogFields& number(std::string_view name, double value);  ///< null where it is not finite
  /// `"a":1,"b":"c"`.
  [[nodiscard]] const std::string& members() const { return members_; }

 private:
  void begin(std::string_view name);
  std::string members_;
};

/// One event. `fields` is an object; `time`, `level` and `event` are added.
void log_info(std::string_view event, const Json& fields = Json::object());
void log_info(std::string_view event, const LogFields& fields);
void log_warning(std::string_view event, const Json& fields = Json::object());
void log_error(std::string_view event, const Json& fields = Json::object());

}  // namespace driftlab::server
