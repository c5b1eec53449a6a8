#pragma once
/// The HTTP resources. One file per resource declares its routes and handlers; routes.cpp lists them.
#include "server/api/answer_cache.hpp"
#include "server/api/event_log.hpp"
#include "server/api/keys_in_flight.hpp"
#include "server/auth/gate.hpp"
#include "server/http/bell.hpp"
#include "server/http/router.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/store/backups.hpp"
#include "server/store/bad_states.hpp"
#include "server/store/blobs.hpp"
#include "server/store/resumable_uploads.hpp"
#include "server/store/store.hpp"
#include "server/store/webhook_store.hpp"
#include "server/webhooks/destination.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

namespace driftlab::server {

/// What handlers use. Outlives the router.
struct ApiContext {
  Store& store;  ///< as the caller of the thread sees it (server/auth/visible_store.hpp)
  BlobStore& blobs;
  const Clock& clock;
  Bell& bell;
  EventLog& events;
  std::function<void()> wake_workers;          ///< a job was queued or cancelled
  std::function<std::string()> not_ready_why;  ///< empty text: ready
  std::filesystem::path data;                  ///< the daemon's directory
  AccessStore& access;
  Gate& gate;
  Budgets budgets = {};
  std::function<bool()> make_room = {};             ///< frees what was kept for a full disk; false: there was nothing
  std::function<bool()> is_nearly_full = {};        ///< the disk: what is removed must be gone at once
  std::function<std::string()> metrics = {};        ///< the text that /metrics gives
  std::function<std::size_t()> damaged_blobs = {};  ///< how many stored files are known to be damaged
  /// Makes sure that the columns of a blob are what was written, before they are used, as JobContext::verify_columns.
  std::function<Status(const std::string& sha256)> verify_columns = {};
  /// The same for what is looked at, which must come at once: large columns count as sound until damage was found.
  std::function<Status(const std::string& sha256)> expect_sound_columns = {};
  std::stop_token stopping = {};  ///< requested when the daemon stops: uploads that decode then give up
  WebhookStore* webhooks = nullptr;
  DestinationGuard webhook_guard = {};                          ///< where webhooks may lead
  std::function<void()> wake_deliveries = {};                   ///< there is something to deliver
  std::function<std::vector<StandingState>()> bad_states = {};  ///< what is wrong now
  KeysInFlight keys_in_flight = {};
  std::shared_ptr<ResumableUploads> uploads = {};  ///< those by tus; null where there are no such routes
  Backups* backups = nullptr;
  int computing = 0;                          ///< threads that jobs share; 0: one for each core
  std::function<Result<int>()> workers = {};  ///< jobs that run at a time, in all processes that have the store
  /// The answer to a GET of the API, for the caller that the request names.
  std::function<Response(const Request&)> read = {};
  std::string_view version = DRIFTLAB_VERSION;
  std::function<std::string()> newer_schema = {};  ///< a sentence where the store has a newer program's schema

  /// For a job that is asked for: what it takes is estimated, and no columns are read yet.
  [[nodiscard]] JobContext job_context() const { return {store, blobs, clock, budgets, {}, computing}; }
};

/// Tells who listens to all events how a job stands, and of its result when it has one.
void announce_job(ApiContext& context, const std::string& job_id);

/// Every route of the daemon.
void add_all_routes(Router& router, ApiContext& context);

/// Those of a worker: whether it lives, whether it can work, and its metrics.
void add_health_routes(Router& router, ApiContext& context);

/// The stored answer to the same request, as `replay` has it; what was too long to be kept is read again from where it
/// is, so that it is as it stands now.
[[nodiscard]] Response replay_whole(const ApiContext& context, const IdempotentReply& reply, const Request& request,
                                    const std::string& body_sha256);

/// Makes the answer of a plain route final: replays or remembers idempotent POSTs, refuses those that create where the
/// disk is too full, maps errors to problems, adds an ETag, answers If-None-Match and keeps what depends on rows alone.
/// Thread safe.
class Dispatcher {
 public:
  explicit Dispatcher(ApiContext& context);
  [[nodiscard]] Response run(const Route& route, const Request& request);
  /// The final answer, where it is known without asking the handler. Never blocks on store or disk.
  [[nodiscard]] std::optional<Response> known(const Route& route, const Request& request);

 private:
  [[nodiscard]] Response run_checked(const Route& route, const Request& request);
  [[nodiscard]] Response read_rows(const Handler& handler, const Request& request);
  [[nodiscard]] Response give_kept(const std::string& key, std::uint64_t changes, const Request& request,
                                   const Response& kept);
  [[nodiscard]] Response run_idempotent(const Route& route, const Request& request, const std::string& key);
  /// What the handler says, unless it would create something and too little is free.
  [[nodiscard]] Response make(const Route& route, const Request& request);

  ApiContext& context_;
  AnswerCache answers_;
};

/// Says who asks, in `request.caller`, or why it is refused: 401 without a token that is valid, 403 where its scope is
/// smaller than the route's, and where a browser's session asks for a change without saying from which page. Pages (no
/// route) and routes of the scope `public` are for everybody.
[[nodiscard]] std::optional<Response> admit(Gate& gate, const Route* route, Request& request);

/// Adds `instance` and `request_id` to a problem document; other answers stay as they are.
void complete_problem(const Request& request, Response& response);

}  // namespace driftlab::server
