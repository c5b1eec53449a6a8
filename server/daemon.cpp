#include "server/daemon.hpp"

#include "server/api/api.hpp"
#include "server/api/audit_row.hpp"
#include "server/auth/visible_store.hpp"
#include "server/http/problem.hpp"
#include "server/http/server.hpp"
#include "server/jobs/worker_pool.hpp"
#include "server/noted.hpp"
#include "server/observe/log.hpp"
#include "server/observe/metrics.hpp"
#include "server/open_store.hpp"
#include "server/pages/pages.hpp"
#include "server/process.hpp"
#include "server/program_version.hpp"
#include "server/readiness.hpp"
#include "server/scrubber.hpp"
#include "server/store/backups.hpp"
#include "server/store/disk_reserve.hpp"
#include "server/store/guarded_round.hpp"
#include "server/store/sqlite/backup.hpp"
#include "server/store_gauges.hpp"
#include "server/take_over.hpp"
#include "server/webhooks/deliverer.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace driftlab::server {
namespace {

/// Of the time to stop, the part that running jobs get before they are handed back.
constexpr double kGraceShare = 0.7;
/// Nobody ends the leases of one of several daemons that died but the clock: they are shorter than those of a daemon
/// that has its store alone.
constexpr std::int64_t kSharedLeaseMicros = 20'000'000;
constexpr std::int64_t kMicrosPerDay = 24LL * 3600 * 1'000'000;

/// The threads that jobs share: one for each core unless told otherwise.
int computing_threads(const Settings& settings) {
  return settings.threads > 0 ? settings.threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// These, and the jobs that run at a time: of more than there are threads some would only wait.
void settle_threads(const Settings& settings, WorkerOptions& options) {
  options.computing = computing_threads(settings);
  options.threads = settings.workers > 0 ? std::min(settings.workers, options.computing) : options.computing;
}

}  // namespace

/// Members in the order of construction; destruction is the reverse.
struct Daemon::Parts {
  Parts(std::unique_ptr<BlobStore> blobs_in, OpenedStore store_in, std::unique_ptr<SystemClock> machine,
        std::unique_ptr<Gate> gate_in, WorkerOptions worker_options, const DestinationGuard& webhook_guard,
        const Settings& settings)
      : budgets(settings.budgets),
        backup_period_seconds(3600.0 * settings.backup_hours),
        reserve(settings.data / "reserve", settings.budgets.reserve_bytes),
        machine_clock(std::move(machine)),
        clock(*store_in.clock),
        blobs(std::move(blobs_in)),
        directory_lock(std::move(store_in.lock)),
        store(std::move(store_in.store)),
        others(store_in.others),
        visible(make_visible_store(*store)),
        states(clock, note_state, [this](const auto&... words) { return store->access().note_state(words...); }),
        readiness(*store, *blobs, states),
        gate(std::move(gate_in)),
        scrubber(*store, *blobs, states, decode_limits(budgets), budgets.scrub_bytes_per_second,
                 [this] { return has_duty(Duty::Scrubbing); }),
        deliverer(store->webhooks(), clock, delivery_options(webhook_guard)),
        jobs_at_once(worker_options.threads),
        workers(
            {*store, *blobs, clock, budgets, [this](const std::string& blob) { return scrubber.verify_columns(blob); },
             computing_threads(settings)},
            maintained(std::move(worker_options)),
            [this](const std::string& id) {
              bell.ring(id);
              announce_job(api, id);
              deliverer.wake();
            }),
        api{*visible,
            *blobs,
            clock,
            bell,
            events,
            [this] { workers.wake(); },
            [this] { return not_ready_why(); },
            settings.data,
            store->access(),
            *gate,
            budgets,
            [this] { return reserve.release(); },
            [this] { return is_nearly_full(); },
            [this] { return metrics.text(gauges(), program_version()); },
            [this] { return scrubber.findings().damaged; },
            [this](const std::string& blob) { return scrubber.verify_columns(blob); },
            [this](const std::string& blob) { return scrubber.expect_sound_columns(blob); },
            stop_uploads.get_token(),
            &store->webhooks(),
            webhook_guard,
            [this] { deliverer.wake(); },
            [this] { return states.standing(); }},
        backups(clock, backup_options(settings)),
        dispatcher(api) {
    store->tell_damage_to([this](const Error& error) { scrubber.note_damaged_row(damaged_row_of(error)); });
    (void)gate->load();  // once more, for nobody was told yet of a token whose row is damaged
    if (store_in.lost_commits > 0) {
      states.begin(BadState::WritesLost, "damage",
                   "The database lacks " + std::to_string(store_in.lost_commits) +
                       " transactions that were acknowledged; its write-ahead log was cut or taken away, or an older "
                       "database put in its place. Compare it with a backup.");
    }
    api.computing = computing_threads(settings);
    api.backups = &backups;
    api.version = program_version();
    api.read = [this](const Request& request) {
      Router::Match match = router.match(request.method, request.path);
      if (match.route == nullptr || !std::holds_alternative<Handler>(match.route->handler)) {
        return problem_response(HttpFault::NoSuchResource, "There is no resource at " + request.path + ".");
      }
      Request with_id = request;
      with_id.parameters = std::move(match.parameters);
      return dispatcher.run(*match.route, with_id);
    };
    api.newer_schema = [this] { return store->newer_schema(); };
    api.workers = [this] { return others == nullptr ? Result<int>(jobs_at_once) : others->workers(); };
    settings.serves_api ? add_all_routes(router, api) : add_health_routes(router, api);
    if (others != nullptr) {
      api.keys_in_flight.share(others);
      events.share([this](const std::string& words) { others->tell(words); });
    }
  }

  [[nodiscard]] bool has_duty(Duty duty) const { return others == nullptr || others->has_duty(duty); }

  /// What other daemons and workers did, as if it had been done here.
  [[nodiscard]] Hints hints() {
    Hints hints;
    hints.job = [this](const std::string& id, std::string_view what) {
      if (what == "queued" || what == "parts" || what == "cancel") {
        workers.wake();
      }
      bell.ring(id);
      announce_job(api, id);
      deliverer.wake();
    };
    hints.words = [this](const std::string& words) { events.add_words(words); };
    hints.access = [this] {
      if (const auto loaded = gate->load(); !loaded) {
        log_warning("tokens were not read again", Json{{"detail", loaded.error().message}});
      }
    };
    hints.lost = [this] {
      events.forget();
      workers.wake();
      deliverer.wake();
    };
    return hints;
  }

  WorkerOptions maintained(WorkerOptions options) {
    options.problem_document = [this](const Error& error) {
      if (error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull || error.code == ErrorCode::Internal) {
        note_failure(states, error, Json{{"of", "job"}});
      }
      return problem_document(error);
    };
    options.parts_helped = [this](std::string_view kind, int parts) { metrics.count_helped(kind, parts); };
    options.attempt_ended = [this](std::string_view kind, std::string_view outcome, double seconds) {
      metrics.count_attempt(kind, outcome, seconds);
    };
    options.maintenance.budgets = budgets;
    options.maintenance.is_mine = [this] { return has_duty(Duty::Maintenance); };
    options.maintenance.is_nearly_full = [this] { return is_nearly_full(); };
    options.maintenance.expired = [this](const StoredRecording& gone) {
      log_info("recording expired",
               Json{{"recording", gone.id}, {"device", gone.device_id}, {"created_at", rfc3339(gone.created_at)}});
      events.add("recordings", "recording.deleted", Json{{"recording", gone.id}, {"device", gone.device_id}});
      workers.wake();  // what its results took part in is pooled anew
    };
    options.maintenance.make_room = [this] { return reserve.release(); };
    options.maintenance.failed = [this](const Error& error) {
      note_failure(states, error, Json{{"of", "removal of what is old"}});
    };
    options.maintenance.each_turn = [this] {
      look_after_reserve();
      look_after_uploads();
      readiness.look_after();
      tell_newer_schema();
      states.look_after();
    };
    options.maintenance.each_tidy = [this] {
      (void)store->webhooks().forget_deliveries(clock.now() - budgets.keep_deliveries_days * kMicrosPerDay);
    };
    return options;
  }

  BackupOptions backup_options(const Settings& settings) {
    BackupOptions options;
    options.directory = settings.backups;
    options.every_micros = settings.backup_hours * kMicrosPerDay / 24;
    options.keep = static_cast<std::size_t>(settings.keep_backups);
    options.make = [data = settings.data](const auto& target, const std::string& now, const std::stop_token& stop) {
      return back_up(data, target, now, stop);
    };
    options.describe = manifest_of;
    options.ended = [this](const Backup& backup) {
      const Json facts{{"backup", backup.name},
                       {"recordings", backup.blobs},
                       {"bytes", backup.bytes},
                       {"faults", backup.failure ? Json{backup.failure->message} : Json(backup.faults)}};
      const std::string state(name_of(backup.state));
      if (backup.state == BackupState::Complete) {
        log_info("backup complete", facts);
      } else {
        log_error("backup " + state, facts);
      }
      (void)store->access().note_state("backup." + state, backup.name,
                                       backup.faults.empty() ? "" : backup.faults.front());
      note_backup(backup);
    };
    return options;
  }

  /// A backup that failed leaves the daemon ready: it is shown, and work goes on.
  void note_backup(const Backup& backup) {
    if (backup.state == BackupState::Complete) {
      states.end(BadState::BackupsFail);
    } else if (backup.state == BackupState::Damaged) {
      states.begin(BadState::BackupsFail, "damage", "The last backup found damage: " + backup.faults.front());
    } else if (backup.failure && backup.failure->code != ErrorCode::Cancelled) {
      states.begin(BadState::BackupsFail, cause_of(*backup.failure),
                   "The last backup failed: " + backup.failure->message);
    }
  }

  DelivererOptions delivery_options(const DestinationGuard& guard) {
    DelivererOptions options;
    options.budgets = budgets;
    options.guard = guard;
    options.is_mine = [this] { return has_duty(Duty::Deliveries); };
    options.attempted = [this](const DueDelivery& what, std::string_view outcome, const std::string& error) {
      metrics.count_delivery(outcome);
      log_info("webhook attempted", Json{{"webhook", what.webhook.id},
                                         {"delivery", what.delivery.id},
                                         {"type", what.delivery.event},
                                         {"attempt", what.delivery.attempts + 1},
                                         {"outcome", outcome},
                                         {"detail", error}});
    };
    options.disabled = [](const std::string& id) { log_warning("webhook disabled", Json{{"webhook", id}}); };
    return options;
  }

  [[nodiscard]] std::string not_ready_why() const { return stopping ? "The daemon is stopping." : readiness.why_not(); }
  [[nodiscard]] bool is_nearly_full() const { return readiness.is_nearly_full(); }

  [[nodiscard]] Gauges gauges() const {
    Gauges found;
    found.ready = not_ready_why().empty() ? 1.0 : 0.0;
    found.started_at = static_cast<double>(started_at) / 1e6;
    if (http) {
      const HttpServer::Load load = http->load();
      found.connections = static_cast<double>(load.connections);
      found.idle_connections = static_cast<double>(load.idle);
      found.uploads = static_cast<double>(load.uploads);
      found.requests_in_flight = static_cast<double>(load.in_flight);
      found.turned_away = static_cast<double>(load.turned_away);
    }
    add_store_gauges(found, *store, clock);
    add_disk_gauges(found, *blobs);
    add_state_gauges(found, states);
    if (const auto begun_at = backups.none_since()) {
      found.backup_age_seconds = static_cast<double>(std::max<UtcMicros>(0, clock.now() - *begun_at)) / 1e6;
    }
    found.backup_period_seconds = backup_period_seconds;
    const Scrubber::Findings stored = scrubber.findings();
    found.blobs_damaged = static_cast<double>(stored.damaged);
    found.blobs_healed = static_cast<double>(stored.healed);
    found.scrubbed_bytes = static_cast<double>(stored.bytes_read);
    found.log_lines_dropped = static_cast<double>(dropped_log_lines());
    const ProcessUse use = use_of_this_process();
    found.resident_bytes = use.resident_bytes;
    found.cpu_seconds = use.cpu_seconds;
    return found;
  }

  /// Once for each schema: a newer program has changed the store, and this one works on.
  void tell_newer_schema() {
    std::string sentence = store->newer_schema();
    if (sentence != told_schema && !sentence.empty()) {
      log_warning("newer schema", Json{{"detail", sentence}});
    }
    told_schema = std::move(sentence);
  }

  /// Hears nothing more of other daemons.
  void silence() {
    if (others != nullptr) {
      others->stop();
    }
  }

  /// Holds the reserve again once there is room for it.
  void look_after_reserve() {
    const auto space = blobs->space();
    if (space && space->free_bytes > static_cast<std::uintmax_t>(budgets.reserve_bytes + budgets.least_free_bytes)) {
      (void)reserve.hold();
    }
  }

  /// Resumable uploads that nobody goes on with, once an hour: they lie in this daemon's own directory.
  void look_after_uploads() {
    const auto now = std::chrono::steady_clock::now();
    if (api.uploads && (!uploads_looked_at || now - *uploads_looked_at > std::chrono::hours(1))) {
      uploads_looked_at = now;
      api.uploads->forget_expired();
    }
  }

  std::atomic<bool> stopping{false};
  std::optional<std::chrono::steady_clock::time_point> uploads_looked_at;
  const Budgets budgets;
  const double backup_period_seconds;
  std::stop_source stop_uploads;
  Metrics metrics;
  UtcMicros started_at = SystemClock().now();
  std::string told_schema;  ///< the sentence that the log has of it
  DiskReserve reserve;
  std::unique_ptr<SystemClock> machine_clock;
  const Clock& clock;  ///< by which the store dates its rows
  std::unique_ptr<BlobStore> blobs;
  FileHandle directory_lock;
  std::unique_ptr<SqlStore> store;
  Coordination* others;  ///< nullptr: this process has the store alone
  std::unique_ptr<Store> visible;
  BadStates states;
  Readiness readiness;
  std::unique_ptr<Gate> gate;
  Scrubber scrubber;
  Bell bell;
  EventLog events{bell, make_id("run", clock.now()).substr(14)};
  Deliverer deliverer;
  const int jobs_at_once;
  WorkerPool workers;
  ApiContext api;
  Backups backups;
  Dispatcher dispatcher;
  Router router;
  Pages pages{dashboard_files()};
  CertificateFiles certificate;
  std::unique_ptr<HttpServer> http;
};

Daemon::Daemon(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Daemon::~Daemon() { stop(); }

Result<std::unique_ptr<Daemon>> Daemon::start(const Settings& settings) {
  const auto address = listen_address(settings);
  if (!address) {
    return fail(address.error());
  }
  if (!settings.backups.empty() && !settings.store.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "--backups is for an SQLite store; back up a PostgreSQL database by pg_dump, and --data as it is.",
                {{"parameter", "backups"}});
  }
  // Before anything is made: whether there are tokens is known only from the store, which may not exist yet.
  std::error_code absent;
  const bool may_have_tokens =
      !settings.store.empty() || std::filesystem::exists(settings.data / "driftlab.db", absent);
  if (auto safe = require_safe_address(settings, *address, may_have_tokens); !safe) {
    return fail(safe.error());
  }
  auto webhook_guard = DestinationGuard::with(settings.webhook_allow);
  if (!webhook_guard) {
    return fail(webhook_guard.error());
  }
  std::shared_ptr<boost::asio::ssl::context> tls;
  if (!settings.tls_certificate.empty()) {
    auto loaded = load_certificate({settings.tls_certificate, settings.tls_key});
    if (!loaded) {
      return fail(loaded.error());
    }
    tls = std::move(*loaded);
  }
  tell_escapes_to(note_escape);
  auto machine = std::make_unique<SystemClock>();
  auto opened = open_store(settings, *machine, [](const AuditRow& row) { log_info("audit", to_json(row)); });
  if (!opened) {
    return fail(opened.error());
  }
  opened->facts["version"] = program_version();
  log_info("store opened", opened->facts);
  SqlStore& store = *opened->store;
  auto blobs = open_blobs(settings, *opened);
  if (!blobs) {
    return fail(blobs.error());
  }
  if (auto taken = take_over(store, opened->others, settings); !taken) {
    return fail(taken.error());
  }
  auto gate = std::make_unique<Gate>(store.access(), *opened->clock,
                                     GateOptions{settings.require_tokens, tls != nullptr, settings.budgets});
  if (auto guarded = open_gate(*gate, settings); !guarded) {
    return fail(guarded.error());
  }
  if (auto safe = require_safe_address(settings, *address, gate->is_on()); !safe) {
    return fail(safe.error());
  }
  WorkerOptions worker_options;
  settle_threads(settings, worker_options);
  if (opened->others != nullptr) {
    worker_options.lease_micros = kSharedLeaseMicros;
    worker_options.renew_micros = kSharedLeaseMicros / 4;
  }
  worker_options.grace_micros =
      static_cast<std::int64_t>(kGraceShare * 1e6 * static_cast<double>(settings.budgets.stop_seconds));
  auto parts = std::make_unique<Parts>(std::move(*blobs), std::move(*opened), std::move(machine), std::move(gate),
                                       std::move(worker_options), std::move(*webhook_guard), settings);

  HttpOptions options;
  options.address = address->address;
  options.port = address->port;
  options.io_threads = settings.io_threads;
  options.budgets = settings.budgets;
  options.proxies = networks(settings.proxies);
  options.guard.hosts = allowed_hosts(settings, *address);
  options.guard.secure = tls != nullptr;
  options.tls = std::move(tls);
  parts->certificate = {settings.tls_certificate, settings.tls_key};
  options.guard.target_bytes = static_cast<std::size_t>(settings.budgets.target_bytes);
  Parts* const shared = parts.get();
  HttpHooks hooks;
  hooks.admit = [shared](const Route* route, Request& request) { return admit(*shared->gate, route, request); };
  hooks.still_admitted = [shared](const Principal& who) { return shared->gate->is_valid(who); };
  hooks.dispatch = [shared](const Route& route, const Request& request) {
    Response response = shared->dispatcher.run(route, request);
    if (const auto flushed = route.lane == Lane::Instant ? Status{} : shared->gate->flush_use(); !flushed) {
      log_warning("the last use of tokens was not written", Json{{"detail", flushed.error().message}});
    }
    return response;
  };
  hooks.known = [shared](const Route& route, const Request& request) {
    return shared->dispatcher.known(route, request);
  };
  if (settings.serves_api) {
    hooks.page = [shared](const Request& request) { return shared->pages.answer(request); };
  }
  hooks.complete = complete_problem;
  hooks.make_request_id = [shared] { return make_id("req", shared->clock.now()); };
  hooks.log = [shared](const AccessRecord& record) { note_request(shared->metrics, shared->states, record); };
  parts->http = std::make_unique<HttpServer>(std::move(options), parts->router, parts->bell, std::move(hooks));
  if (parts->others != nullptr) {
    parts->others->listen(parts->hints());
    parts->others->offer_workers(parts->jobs_at_once);
  }
  parts->workers.start();
  parts->scrubber.start();
  if (settings.serves_api) {
    parts->backups.start();
    parts->deliverer.start();
  }
  if (auto started = parts->http->start(); !started) {
    parts->silence();
    parts->workers.stop();
    parts->deliverer.stop();
    return fail(started.error());
  }
  log_info("listening", Json{{"address", settings.listen},
                             {"port", parts->http->port()},
                             {"tls", parts->certificate.chain.empty() ? "off" : "on"},
                             {"authentication", parts->gate->is_on() ? "on" : "off"}});
  return std::unique_ptr<Daemon>(new Daemon(std::move(parts)));
}

void Daemon::reload() {
  if (const Status reopened = reopen_log(); !reopened) {
    log_error("cannot reload", Json{{"detail", reopened.error().message}});
  }
  if (parts_->certificate.chain.empty()) {
    log_info("reloaded");
    return;
  }
  auto context = load_certificate(parts_->certificate);
  if (!context) {
    log_error("the certificate was not reloaded; the old one stays", Json{{"detail", context.error().message}});
    return;
  }
  parts_->http->show(std::move(*context));
  log_info("certificate reloaded", Json{{"file", parts_->certificate.chain.string()}});
}

bool Daemon::is_alive(std::chrono::milliseconds patience) const { return parts_->http->is_alive(patience); }

std::uint16_t Daemon::port() const { return parts_->http->port(); }

void Daemon::stop() {
  if (parts_->stopping.exchange(true)) {
    return;
  }
  log_info("stopping");
  // Not ready, but still there: who distributes requests sees it and sends no more. Jobs end meanwhile.
  parts_->workers.ask_to_stop();
  std::this_thread::sleep_for(std::chrono::milliseconds(parts_->budgets.drain_milliseconds));
  std::thread jobs([this] {
    parts_->workers.stop();
    parts_->scrubber.stop();
    parts_->backups.stop();
    parts_->deliverer.stop();
  });
  const std::chrono::milliseconds grace(
      static_cast<std::int64_t>(kGraceShare * 1e3 * static_cast<double>(parts_->budgets.stop_seconds)));
  // Requests under way are finished. An upload that still decodes half of that time later gives up.
  std::jthread late_uploads([this, grace](const std::stop_token& finished) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, finished, grace / 2, [] { return false; });
    if (!finished.stop_requested()) {
      parts_->stop_uploads.request_stop();
    }
  });
  parts_->http->stop(grace);
  late_uploads.request_stop();
  jobs.join();
  parts_->silence();
  (void)parts_->gate->flush_use(true);
  log_info("stopped");
}

}  // namespace driftlab::server
