#include "server/observe/log.hpp"

#include "server/store/clock.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <string>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::size_t kPendingLines = 8192;

/// The thread that writes; the log owns it.
std::shared_ptr<spdlog::details::thread_pool>& writer() {
  static std::shared_ptr<spdlog::details::thread_pool> pool;
  return pool;
}

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
  writer() = std::make_shared<spdlog::details::thread_pool>(kPendingLines, 1);
  auto logger = std::make_shared<spdlog::async_logger>("driftlab", std::make_shared<spdlog::sinks::stderr_sink_mt>(),
                                                       writer(), spdlog::async_overflow_policy::overrun_oldest);
  logger->set_pattern("%v");
  logger->set_level(spdlog::level::from_str(std::string(level)));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void stop_log() {
  writer().reset();  // writes what is pending and joins the thread, so that nobody uses the logger while it goes
  spdlog::shutdown();
}

void log_debug(std::string_view event, const Json& fields) { write(spdlog::level::debug, "debug", event, fields); }
void log_info(std::string_view event, const Json& fields) { write(spdlog::level::info, "info", event, fields); }
void log_warning(std::string_view event, const Json& fields) { write(spdlog::level::warn, "warning", event, fields); }
void log_error(std::string_view event, const Json& fields) { write(spdlog::level::err, "error", event, fields); }

}  // namespace driftlab::server
