#pragma once
/// What happened lately, for the stream that a page listens to (GET /v1/events).
///
/// A hint like the bell: the store is what holds. The last thousand events are kept in memory, numbered since the
/// daemon started; an id is the daemon's run and that number. A listener whose last event is of another run or no
/// longer kept is told to read everything anew.
#include "schema/json/json.hpp"
#include "server/http/bell.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

struct LoggedEvent {
  std::int64_t number = 0;  ///< from 1
  std::string topic;        ///< `jobs`, `recordings`, `devices`, `results`
  std::string type;         ///< `job`, `recording.created`, ...
  std::string data;         ///< JSON
};

class EventLog {
 public:
  /// For what the bell rings when something was added.
  static constexpr std::string_view kSubject = "events";

  /// `run` tells this daemon's events from those of another run: letters and digits.
  EventLog(Bell& bell, std::string run) : bell_(bell), run_(std::move(run)) {}

  /// Tells also `share`'s listener, unless it is of a topic that every daemon sees in the store by itself: jobs and
  /// results.
  void add(std::string_view topic, std::string_view type, const Json& data);

  /// What this daemon adds is told as words that `add_words` of another daemon understands. Before the first event.
  void share(std::function<void(const std::string& words)> tell) { tell_ = std::move(tell); }
  void add_words(const std::string& words);
  /// Events of others may have been missed: every listener is told to read everything anew.
  void forget();

  [[nodiscard]] std::int64_t latest() const;
  /// Events behind number `after`, at most `most`. `complete` is false where some of them are no longer kept.
  struct Since {
    std::vector<LoggedEvent> events;
    bool complete = true;
  };
  [[nodiscard]] Since since(std::int64_t after, std::size_t most) const;

  /// The id of an event on the wire, and its number where the id is of this run.
  [[nodiscard]] std::string id_of(std::int64_t number) const { return run_ + '-' + std::to_string(number); }
  [[nodiscard]] std::optional<std::int64_t> number_of(std::string_view id) const;

 private:
  void keep(std::string topic, std::string type, std::string data);

  Bell& bell_;
  const std::string run_;
  std::function<void(const std::string& words)> tell_;
  mutable std::mutex mutex_;
  std::deque<LoggedEvent> kept_;
  std::int64_t latest_ = 0;
};

}  // namespace driftlab::server
