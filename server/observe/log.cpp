#include "server/observe/log.hpp"

#include "server/store/clock.hpp"
#include "server/store/files.hpp"

#include <fcntl.h>
#include <spdlog/async.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::size_t kPendingLines = 8192;

/// Where lines go: a descriptor of its own, never the number 2 of whatever came to be there.
class LogSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LogSink(std::string file) : path_(std::move(file)) {}

  /// Error: Io.
  Status open() {
    FileHandle opened(path_.empty() ? ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)
                                    : ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640));
    if (!opened) {
      return fail(file_error(errno, "open the log", path_.empty() ? "standard error" : path_));
    }
    const std::lock_guard<std::mutex> guard(base_sink::mutex_);
    handle_ = std::move(opened);
    return {};
  }
  [[nodiscard]] bool is_file() const { return !path_.empty(); }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    base_sink::formatter_->format(message, line);
    const char* next = line.data();
    std::size_t left = line.size();
    while (left > 0) {
      const ssize_t written = ::write(handle_.get(), next, left);
      if (written < 0 && errno != EINTR) {
        lost_.fetch_add(1);
        return;
      }
      next += written > 0 ? written : 0;
      left -= static_cast<std::size_t>(written > 0 ? written : 0);
    }
  }
  void flush_() override {}

 public:
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  std::string path_;
  FileHandle handle_;
  std::atomic<std::uint64_t> lost_{0};
};

std::shared_ptr<LogSink>& sink() {
  static std::shared_ptr<LogSink> one;
  return one;
}

/// The thread that writes; the log owns it.
std::shared_ptr<spdlog::details::thread_pool>& writer() {
  static std::shared_ptr<spdlog::details::thread_pool> pool;
  return pool;
}

/// Text as JSON: as it stands between its quotes where nothing in it needs an escape, as hardly anything does.
void append_quoted(std::string& line, std::string_view text) {
  const bool plain = std::ranges::all_of(text, [](char c) { return c >= 0x20 && c < 0x7F && c != '"' && c != '\\'; });
  if (!plain) {
    line += to_text(Json(std::string(text)));
    return;
  }
  line += '"';
  line += text;
  line += '"';
}

bool is_logged(spdlog::level::level_enum level) {
  const auto logger = spdlog::default_logger();
  return logger && logger->should_log(level);
}

/// `members` are those of an object, without its braces.
void write(spdlog::level::level_enum level, std::string_view name, std::string_view event, std::string_view members) {
  if (!is_logged(level)) {
    return;
  }
  std::string line = "{\"time\":\"" + rfc3339(SystemClock().now()) + "\",\"level\":\"";
  line.reserve(line.size() + event.size() + members.size() + 64);
  line += name;
  line += "\",\"event\":";
  append_quoted(line, event);
  if (!members.empty()) {
    line += ',';
    line += members;
  }
  line += '}';
  spdlog::default_logger()->log(level, line);
}

void write_document(spdlog::level::level_enum level, std::string_view name, std::string_view event,
                    const Json& fields) {
  if (!is_logged(level)) {
    return;
  }
  const std::string object = to_text(fields);
  write(level, name, event, std::string_view(object).substr(1, object.size() - 2));
}

}  // namespace

Status start_log(std::string_view level, const std::string& file) {
  sink() = std::make_shared<LogSink>(file);
  if (Status opened = sink()->open(); !opened) {
    return opened;
  }
  writer() = std::make_shared<spdlog::details::thread_pool>(kPendingLines, 1);
  auto logger = std::make_shared<spdlog::async_logger>("driftlab", sink(), writer(),
                                                       spdlog::async_overflow_policy::overrun_oldest);
  logger->set_pattern("%v");
  logger->set_level(spdlog::level::from_str(std::string(level)));
  spdlog::set_default_logger(std::move(logger));
  return {};
}

Status reopen_log() { return sink() && sink()->is_file() ? sink()->open() : Status{}; }

std::uint64_t dropped_log_lines() {
  return (writer() ? writer()->overrun_counter() : 0) + (sink() ? sink()->lost() : 0);
}

void stop_log() {
  writer().reset();  // writes what is pending and joins the thread, so that nobody uses the logger while it goes
  spdlog::shutdown();
}

void LogFields::begin(std::string_view name) {
  if (!members_.empty()) {
    members_ += ',';
  }
  members_ += '"';
  members_ += name;
  members_ += "\":";
}

LogFields& LogFields::text(std::string_view name, std::string_view value) {
  begin(name);
  append_quoted(members_, value);
  return *this;
}

LogFields& LogFields::text_or_null(std::string_view name, std::string_view value) {
  if (!value.empty()) {
    return text(name, value);
  }
  begin(name);
  members_ += "null";
  return *this;
}

LogFields& LogFields::count(std::string_view name, std::uint64_t value) {
  begin(name);
  members_ += std::to_string(value);
  return *this;
}

LogFields& LogFields::number(std::string_view name, double value) {
  begin(name);
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  members_ += std::isfinite(value) ? std::string_view(digits.data(), written.ptr) : std::string_view("null");
  return *this;
}

void log_info(std::string_view event, const LogFields& fields) {
  write(spdlog::level::info, "info", event, fields.members());
}
void log_info(std::string_view event, const Json& fields) {
  write_document(spdlog::level::info, "info", event, fields);
}
void log_warning(std::string_view event, const Json& fields) {
  write_document(spdlog::level::warn, "warning", event, fields);
}
void log_error(std::string_view event, const Json& fields) {
  write_document(spdlog::level::err, "error", event, fields);
}

}  // namespace driftlab::server
