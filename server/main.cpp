// driftlabd: the driftlab daemon. See `driftlabd --help` and schema/docs/operations.md.
#include "server/access_commands.hpp"
#include "server/configuration.hpp"
#include "server/daemon.hpp"
#include "server/manual_commands.hpp"
#include "server/move_store.hpp"
#include "server/moved_tables.hpp"
#include "server/observe/log.hpp"
#include "server/process.hpp"
#include "server/program_version.hpp"
#include "server/service_manager.hpp"
#include "server/store/clock.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/sqlite/backup.hpp"

#include <CLI/CLI.hpp>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace {

using driftlab::server::Configuration;
using driftlab::server::Daemon;
using driftlab::server::Settings;

/// The point that DRIFTLAB_CRASH_AT names, which is read before any thread exists. False: there is no such point.
bool arm_crash() {
  const char* const crash_at = std::getenv("DRIFTLAB_CRASH_AT");  // NOLINT(concurrency-mt-unsafe)
  if (crash_at == nullptr || driftlab::server::arm_crash_point(crash_at)) {
    return true;
  }
  std::fprintf(stderr, "driftlabd: DRIFTLAB_CRASH_AT names no crash point\n");
  return false;
}

int serve(const Settings& settings) {
  driftlab::server::Signals signals;
  driftlab::server::ServiceManager manager;
  if (const auto opened = driftlab::server::start_log(settings.log_level, settings.log_file); !opened) {
    std::fprintf(stderr, "driftlabd: %s\n", opened.error().message.c_str());
    return 1;
  }
  auto daemon = Daemon::start(settings);
  if (!daemon) {
    driftlab::server::log_error("cannot start", driftlab::Json{{"detail", daemon.error().message}});
    driftlab::server::stop_log();
    std::fprintf(stderr, "driftlabd: %s\n", daemon.error().message.c_str());
    return daemon.error().code == driftlab::ErrorCode::InvalidArgument ? 2 : 1;
  }
  manager.tell("READY=1");
  manager.watch([&daemon](std::chrono::milliseconds patience) { return (*daemon)->is_alive(patience); });
  signals.wait_for_stop([&daemon, &manager] {
    manager.tell("RELOADING=1");
    (*daemon)->reload();
    manager.tell("READY=1");
  });
  manager.stop_watching();
  manager.tell("STOPPING=1");
  signals.end_process_after(std::chrono::seconds(settings.budgets.stop_seconds));
  (*daemon)->stop();
  daemon->reset();
  driftlab::server::stop_log();
  return 0;
}

/// Runs a worker: a daemon without an API beside the daemons of one database.
int work(Settings settings) {
  if (settings.store.empty() || settings.blobs.empty()) {
    std::fprintf(stderr,
                 "driftlabd: A worker works on the jobs of a PostgreSQL database (--store) whose recordings it reaches "
                 "(--blobs).\n");
    return 2;
  }
  settings.serves_api = false;
  return serve(settings);
}

/// The settings as TOML that could be read again, each with its origin; or as JSON.
int show(const Configuration& configuration, bool json) {
  if (json) {
    std::printf("%s\n", to_json(configuration).dump(2).c_str());
    return 0;
  }
  std::string_view table;
  for (const auto& one : configuration.values) {
    std::string_view name = one.name;
    if (name.starts_with("budgets.")) {
      if (table.empty()) {
        table = "budgets";
        std::printf("\n[budgets]\n");
      }
      name.remove_prefix(8);
    }
    std::printf("%-26s = %-20s # %s\n", std::string(name).c_str(), one.value.dump().c_str(), one.origin.c_str());
  }
  return 0;
}

int list_crash_points() {
  for (const std::string_view name : driftlab::server::crash_point_names()) {
    std::printf("%.*s\n", static_cast<int>(name.size()), name.data());
  }
  return 0;
}

/// A flag for every setting; texts go to `given` as they are and are read with those of the other sources.
void add_settings(CLI::App& app, driftlab::server::GivenFlags& given) {
  for (const auto& setting : driftlab::server::all_settings()) {
    std::string flag = "--" + std::string(setting.name);
    std::replace(flag.begin(), flag.end(), '_', '-');
    std::vector<std::string>& values = given.values[std::string(setting.name)];
    const std::string meaning(setting.meaning);
    if (setting.kind == driftlab::server::SettingKind::Switch) {
      app.add_flag_callback(flag, [&values] { values.assign(1, "true"); }, meaning);
      continue;
    }
    const auto shown = setting.get(Settings{});
    auto* const option = app.add_option(flag, values, meaning)->allow_extra_args(false);
    if (setting.kind == driftlab::server::SettingKind::Text) {
      option->default_str(shown.is_string() ? shown.get<std::string>() : shown.dump());
    }
  }
  app.add_option("--config", given.file, "TOML file of settings")->allow_extra_args(false);
  app.add_option("--budget", given.budgets, "NAME=VALUE of a budget; `driftlabd config` lists them")
      ->allow_extra_args(false);
}

/// Says what a check, a backup or a restore found. 0: all is well; 1: it could not be done, or something is damaged.
int tell(const char* what, const driftlab::Result<driftlab::server::StoreReport>& report) {
  if (!report) {
    std::fprintf(stderr, "driftlabd: %s\n", report.error().message.c_str());
    return report.error().code == driftlab::ErrorCode::Conflict ? 2 : 1;
  }
  for (const std::string& fault : report->faults) {
    std::fprintf(stderr, "driftlabd: %s\n", fault.c_str());
  }
  std::printf("%s: %lld files of recordings, %lld bytes, %zu faults\n", what, static_cast<long long>(report->blobs),
              static_cast<long long>(report->bytes), report->faults.size());
  return report->faults.empty() ? 0 : 1;
}

int tell_moved(const driftlab::Result<driftlab::server::MovedStore>& moved, bool ahead) {
  if (!moved) {
    std::fprintf(stderr, "driftlabd: %s\n", moved.error().message.c_str());
    return moved.error().code == driftlab::ErrorCode::Conflict ||
                   moved.error().code == driftlab::ErrorCode::InvalidArgument
               ? 2
               : 1;
  }
  const driftlab::server::MovedRows& rows = moved->rows;
  const auto count = [](std::int64_t number) { return static_cast<long long>(number); };
  if (ahead) {
    std::printf(
        "copied ahead: %lld recordings, %lld of them in this run; %lld rows, %lld new, %lld changed, %lld gone\n",
        count(moved->blobs), count(moved->new_blobs), count(rows.rows), count(rows.added), count(rows.changed),
        count(rows.removed));
    if (!moved->rows_left.empty()) {
      std::printf("rows are left for the move itself: %s\n", moved->rows_left.c_str());
    }
    return 0;
  }
  std::printf("moved: %lld rows of %d tables and %lld recordings, %lld and %lld of them in this run; all compared\n",
              count(rows.rows), driftlab::server::moved_table_count(), count(moved->blobs),
              count(rows.added + rows.changed), count(moved->new_blobs));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  driftlab::server::occupy_standard_descriptors();
  ::umask(077);  // recordings are the lab's own, and the database holds the secrets of webhooks
  CLI::App app{
      "driftlabd serves the characterisation of inertial sensors over HTTP.\n"
      "Flags win over DRIFTLAB_* variables, which win over the configuration file, which wins over defaults."};
  app.set_version_flag("--version", "driftlabd " + std::string(driftlab::server::program_version()));
  app.fallthrough();
  app.require_subcommand(0, 1);
  driftlab::server::GivenFlags given;
  add_settings(app, given);
  const driftlab::server::AccessCommands access(app);
  const driftlab::server::ManualCommands manual(app);
  const CLI::App* const crash_points =
      app.add_subcommand("crash-points", "List the points where tests may kill the daemon");
  CLI::App* const config = app.add_subcommand("config", "Print every setting and budget with its origin");
  const CLI::App* const check =
      app.add_subcommand("check", "Read everything in --data back and compare it with its checksums");
  CLI::App* const backup = app.add_subcommand("backup", "Copy --data to --to, also while the daemon runs");
  std::string to;
  backup->add_option("--to", to, "Directory to make")->required();
  CLI::App* const restored = app.add_subcommand("restore", "Make --data, which must not be there, from a backup");
  std::string from;
  restored->add_option("--from", from, "Directory that `driftlabd backup` made")->required();
  CLI::App* const migrate = app.add_subcommand("migrate", "Move a lab between --data and a PostgreSQL database");
  std::string move_from;
  std::string move_to;
  migrate->add_option("--from", move_from, "Directory of an SQLite store, or postgresql://... of a database")
      ->required();
  migrate->add_option("--to", move_to, "The other of the two; empty, or what an earlier run has moved so far")
      ->required();
  bool ahead = false;
  migrate->add_flag("--ahead", ahead, "Copy what is there, while the daemons of --from go on; again: what has changed");
  const CLI::App* const worker = app.add_subcommand(
      "worker", "Work on the jobs of --store, without an API; --listen answers /healthz, /readyz and /metrics");
  bool json = false;
  config->add_flag("--json", json, "As JSON, with bounds and meanings");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool wanted = error.get_exit_code() == 0;  // --help, --version
    app.exit(error);
    return wanted ? 0 : 2;
  }
  if (crash_points->parsed()) {
    return list_crash_points();
  }
  if (manual.parsed()) {
    return manual.run();
  }
  if (!arm_crash()) {
    return 2;
  }
  const auto configuration = driftlab::server::configure(given, driftlab::server::own_environment());
  if (!configuration) {
    std::fprintf(stderr, "driftlabd: %s\n", configuration.error().message.c_str());
    return 2;
  }
  const Settings& settings = configuration->settings;
  if (access.parsed()) {
    return access.run(settings);
  }
  if (!settings.store.empty() && (check->parsed() || backup->parsed() || restored->parsed())) {
    std::fprintf(
        stderr,
        "driftlabd: check, backup and restore are for an SQLite store; back up a PostgreSQL database by pg_dump, "
        "and --data as it is.\n");
    return 2;
  }
  if (migrate->parsed()) {
    return tell_moved(ahead ? driftlab::server::move_ahead(settings, move_from, move_to)
                            : driftlab::server::move_store(settings, move_from, move_to),
                      ahead);
  }
  if (check->parsed()) {
    return tell("checked", driftlab::server::check_data(settings.data));
  }
  if (backup->parsed()) {
    const std::string now = driftlab::server::rfc3339(driftlab::server::SystemClock().now());
    return tell("backed up", driftlab::server::back_up(settings.data, to, now));
  }
  if (restored->parsed()) {
    return tell("restored", driftlab::server::restore(from, settings.data));
  }
  if (worker->parsed()) {
    return work(settings);
  }
  return config->parsed() ? show(*configuration, json) : serve(settings);
}
