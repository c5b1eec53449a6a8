#include "server/api/event_log.hpp"

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

constexpr std::size_t kMostKept = 1000;

}  // namespace

void EventLog::add(std::string_view topic, std::string_view type, const Json& data) {
  std::string text = to_text(data);
  const bool of_store = topic == "jobs" || topic == "results";
  if (tell_ && !of_store) {
    tell_(std::string(topic) + ' ' + std::string(type) + ' ' + text);
  }
  keep(std::string(topic), std::string(type), std::move(text));
}

void EventLog::add_words(const std::string& words) {
  const std::size_t type = words.find(' ');
  const std::size_t data = type == std::string::npos ? type : words.find(' ', type + 1);
  if (data != std::string::npos) {
    keep(words.substr(0, type), words.substr(type + 1, data - type - 1), words.substr(data + 1));
  }
}

void EventLog::forget() {
  {
    const std::lock_guard lock(mutex_);
    ++latest_;
    kept_.clear();
  }
  bell_.ring(std::string(kSubject));
}

void EventLog::keep(std::string topic, std::string type, std::string data) {
  {
    const std::lock_guard lock(mutex_);
    kept_.push_back({++latest_, std::move(topic), std::move(type), std::move(data)});
    if (kept_.size() > kMostKept) {
      kept_.pop_front();
    }
  }
  bell_.ring(std::string(kSubject));
}

std::int64_t EventLog::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

EventLog::Since EventLog::since(std::int64_t after, std::size_t most) const {
  const std::lock_guard lock(mutex_);
  Since result;
  result.complete = after >= latest_ || (!kept_.empty() && after + 1 >= kept_.front().number);
  for (const LoggedEvent& event : kept_) {
    if (event.number > after && result.events.size() < most) {
      result.events.push_back(event);
    }
  }
  return result;
}

std::optional<std::int64_t> EventLog::number_of(std::string_view id) const {
  const std::size_t dash = id.rfind('-');
  if (dash == std::string_view::npos || id.substr(0, dash) != run_) {
    return std::nullopt;
  }
  const std::string_view digits = id.substr(dash + 1);
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || stop != digits.data() + digits.size() || number < 0 || number > latest()) {
    return std::nullopt;
  }
  return number;
}

}  // namespace driftlab::server
