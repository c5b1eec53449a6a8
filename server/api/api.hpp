#pragma once
/// The HTTP resources. One file per resource declares its routes and handlers; routes.cpp lists them.
#include "server/api/event_log.hpp"
#include "server/http/bell.hpp"
#include "server/http/router.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/store/blobs.hpp"
#include "server/store/store.hpp"

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

/// What handlers use. Outlives the router.
struct ApiContext {
  Store& store;
  BlobStore& blobs;
  const Clock& clock;
  Bell& bell;
  EventLog& events;
  std::function<void()> wake_workers;          ///< a job was queued or cancelled
  std::function<std::string()> not_ready_why;  ///< empty text: ready
  std::filesystem::path data;                  ///< the daemon's directory
};

/// Tells who listens to all events how a job stands, and of its result when it has one.
void announce_job(ApiContext& context, const std::string& job_id);

/// Every route of the daemon.
void add_all_routes(Router& router, ApiContext& context);

/// Makes the answer of a plain route final: replays or remembers idempotent POSTs, maps errors to problems, adds an
/// ETag and answers If-None-Match. Thread safe.
class Dispatcher {
 public:
  explicit Dispatcher(ApiContext& context) : context_(context) {}
  [[nodiscard]] Response run(const Route& route, const Request& request);

 private:
  [[nodiscard]] Response run_idempotent(const Handler& handler, const Request& request, const std::string& key);

  ApiContext& context_;
  std::mutex mutex_;
  std::vector<std::string> in_flight_;
};

/// Adds `instance` and `request_id` to a problem document; other answers stay as they are.
void complete_problem(const Request& request, Response& response);

}  // namespace driftlab::server
