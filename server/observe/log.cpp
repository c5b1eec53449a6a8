#include "server/observe/log.hpp"

#include "server/store/clock.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace driftlab::server {
namespace {

void write(spdlog::level::level_enum level, std::string_view name, std::string_view event, const Json& fields) {
  const auto logger = spdlog::default_logger();
  if (!logger || !logger->should_log(level)) {
    return;
  }
  Json line{{"time", rfc3339(SystemClock().now())}, {"level", name}, {"event", event}};
  for (const auto& [key, value] : fields.items()) {
    line[key] = value;
  }
  logger->log(level, to_text(line));
}

}  // namespace

void start_log(std::string_view level) {
  spdlog::init_thread_pool(8192, 1);
  auto logger = spdlog::create_async_nb<spdlog::sinks::stderr_sink_mt>("driftlab");
  logger->set_pattern("%v");
  logger->set_level(spdlog::level::from_str(std::string(level)));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void stop_log() { spdlog::shutdown(); }

void log_debug(std::string_view event, const Json& fields) { write(spdlog::level::debug, "debug", event, fields); }
void log_info(std::string_view event, const Json& fields) { write(spdlog::level::info, "info", event, fields); }
void log_warning(std::string_view event, const Json& fields) { write(spdlog::level::warn, "warning", event, fields); }
void log_error(std::string_view event, const Json& fields) { write(spdlog::level::err, "error", event, fields); }

}  // namespace driftlab::server
