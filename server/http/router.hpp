#pragma once
/// The route table: what the daemon answers to. schema/openapi.yaml says the same, and a test compares the two.
#include "core/signal/result.hpp"
#include "server/http/message.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

namespace driftlab::server {

/// A plain request: the whole answer from the whole request, on a pool thread; may block on store and disk.
using Handler = std::function<Result<Response>(const Request&)>;

/// A body that streams in. All calls come from pool threads, one after the other. Destroyed without `finish`: nothing
/// is left.
class UploadSession {
 public:
  UploadSession() = default;
  UploadSession(const UploadSession&) = delete;
  UploadSession& operator=(const UploadSession&) = delete;
  virtual ~UploadSession() = default;
  [[nodiscard]] virtual Status append(std::span<const std::byte> bytes) = 0;
  [[nodiscard]] virtual Result<Response> finish() = 0;
};
using UploadHandler = std::function<Result<std::unique_ptr<UploadSession>>(const Request&)>;

/// A server-sent event stream (HTML standard 9.2).
class EventSource {
 public:
  EventSource() = default;
  EventSource(const EventSource&) = delete;
  EventSource& operator=(const EventSource&) = delete;
  virtual ~EventSource() = default;
  struct Batch {
    std::string text;   ///< complete events, ready to send; may be empty
    bool last = false;  ///< nothing will follow
  };
  /// Events since the last call. On a pool thread.
  [[nodiscard]] virtual Result<Batch> next() = 0;
  /// What the bell rings for when there may be more: a job's id, or EventLog::kSubject.
  [[nodiscard]] virtual const std::string& subject() const = 0;
};
using EventHandler = std::function<Result<std::unique_ptr<EventSource>>(const Request&)>;

/// Where a plain handler runs.
enum class Lane : std::uint8_t {
  Instant,  ///< on the I/O thread, for it never blocks: it answers while every pool thread is busy
  Prompt,   ///< on the pool of the handlers: rows, and documents of their size
  Slow,  ///< it reads a whole recording, for seconds: on two threads of their own, and nothing prompt waits behind it
  Decoding,  ///< it decodes what was uploaded before, with a place among the uploads and on their threads
};

struct Route {
  std::string_view method;
  std::string_view pattern;             ///< `/v1/devices/{id}`
  std::string_view operation_id;        ///< as in openapi.yaml
  std::vector<std::string_view> query;  ///< parameters it takes; any other is refused
  std::variant<Handler, UploadHandler, EventHandler> handler;
  Lane lane = Lane::Prompt;
  /// The answer holds a secret: it is kept nowhere, so that it cannot be repeated by Idempotency-Key either.
  bool secret = false;
  /// The answer depends on the rows of the store alone, so that it stands until one of them changes (AnswerCache).
  bool from_rows = false;
  Scope scope = Scope::Admin;  ///< what a token needs; the contract says so (Router::set_scopes)
};

/// The route, whose answer depends on the rows of the store alone.
[[nodiscard]] inline Route from_rows(Route route) {
  route.from_rows = true;
  return route;
}

[[nodiscard]] inline Route in_lane(Lane lane, Route route) {
  route.lane = lane;
  return route;
}

/// The refusal of a query parameter that the route does not take, or that is given twice; nothing if all is well.
[[nodiscard]] std::optional<Response> refuse_unknown_query(const Route& route, const Request& request);

class Router {
 public:
  void add(Route route);
  /// Gives every route the scope that its operation has.
  void set_scopes(const std::function<Scope(std::string_view operation_id)>& scope_of);
  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

  struct Match {
    const Route* route = nullptr;  ///< nullptr: no such method, or no such path
    std::vector<std::string> parameters;
    std::vector<std::string_view> allowed;  ///< methods of that path; empty: no such path
  };
  [[nodiscard]] Match match(std::string_view method, std::string_view path) const;

 private:
  /// Adds to `match` those of `candidates` that the path fits.
  void try_routes(const std::vector<std::size_t>& candidates, std::string_view method,
                  const std::vector<std::string_view>& path, Match& match) const;

  std::vector<Route> routes_;
  std::vector<std::vector<std::string_view>> segments_;  ///< of each route's pattern, between its slashes
  /// Which routes a path may be of by its third segment, in the order that they were added, and which by any.
  std::unordered_map<std::string_view, std::vector<std::size_t>> families_;
  std::vector<std::size_t> others_;
};

}  // namespace driftlab::server
