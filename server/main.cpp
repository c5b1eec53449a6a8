// driftlabd: the driftlab daemon. See `driftlabd --help` and schema/docs/operations.md.
#include "server/access_commands.hpp"
#include "server/api/api.hpp"
#include "server/daemon.hpp"
#include "server/observe/log.hpp"
#include "server/store/crash_point.hpp"

#include <CLI/CLI.hpp>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

namespace {

using driftlab::server::Daemon;
using driftlab::server::Settings;

/// SIGTERM, SIGINT and SIGHUP arrive at the thread that waits for them and at no other.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // A client that goes away in the middle of an answer is an error of that write, not a signal.
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c): SIG_IGN is always accepted for SIGPIPE
  return signals;
}

int serve(const Settings& settings) {
  const sigset_t signals = block_stop_signals();
  driftlab::server::start_log(settings.log_level);
  // Read once, before any thread exists.
  const char* const crash_at = std::getenv("DRIFTLAB_CRASH_AT");  // NOLINT(concurrency-mt-unsafe)
  if (crash_at != nullptr && !driftlab::server::arm_crash_point(crash_at)) {
    std::fprintf(stderr, "driftlabd: DRIFTLAB_CRASH_AT names no crash point\n");
    return 2;
  }
  auto daemon = Daemon::start(settings);
  if (!daemon) {
    driftlab::server::log_error("cannot start", driftlab::Json{{"detail", daemon.error().message}});
    driftlab::server::stop_log();
    std::fprintf(stderr, "driftlabd: %s\n", daemon.error().message.c_str());
    return daemon.error().code == driftlab::ErrorCode::InvalidArgument ? 2 : 1;
  }
  int signal = 0;
  while (sigwait(&signals, &signal) != 0 || signal == SIGHUP) {
    (*daemon)->reload();
  }
  // A second signal ends the process at once; the store is safe at any moment.
  std::thread([&signals] {
    int again = 0;
    while (sigwait(&signals, &again) != 0 || again == SIGHUP) {
    }
    _exit(128 + again);
  }).detach();
  (*daemon)->stop();
  daemon->reset();
  driftlab::server::stop_log();
  return 0;
}

void add_settings(CLI::App& app, Settings& settings) {
  app.add_option("--data", settings.data, "Directory of database and recordings, made if absent")
      ->envname("DRIFTLAB_DATA")
      ->capture_default_str();
  app.add_option("--listen", settings.listen, "IP:PORT to listen on; port 0 takes any free one")
      ->envname("DRIFTLAB_LISTEN")
      ->capture_default_str();
  app.add_option("--allow-host", settings.allow_host, "Another name to answer for in the Host header")
      ->envname("DRIFTLAB_ALLOW_HOST");
  app.add_option("--workers", settings.workers, "Jobs that run at once; 0 is as many as threads")
      ->envname("DRIFTLAB_WORKERS")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  app.add_option("--threads", settings.threads, "Threads that all jobs share; 0 is one per core, or per worker if more")
      ->envname("DRIFTLAB_THREADS")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  app.add_option("--io-threads", settings.io_threads, "Threads that serve connections")
      ->envname("DRIFTLAB_IO_THREADS")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--log-level", settings.log_level, "Least severe events to log")
      ->envname("DRIFTLAB_LOG_LEVEL")
      ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
      ->capture_default_str();
  app.add_option("--tls-certificate", settings.tls_certificate,
                 "PEM file of the certificate and its chain; then HTTPS only")
      ->envname("DRIFTLAB_TLS_CERTIFICATE");
  app.add_option("--tls-key", settings.tls_key, "PEM file of the certificate's private key")
      ->envname("DRIFTLAB_TLS_KEY");
  app.add_flag("--require-tokens", settings.require_tokens,
               "Ask everybody for a token; makes the first one, for an admin, where there is none")
      ->envname("DRIFTLAB_REQUIRE_TOKENS");
  app.add_flag("--insecure", settings.insecure, "Listen beyond loopback without TLS or tokens")
      ->envname("DRIFTLAB_INSECURE");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "driftlabd serves the characterisation of inertial sensors over HTTP.\n"
      "Flags win over DRIFTLAB_* variables, which win over defaults."};
  app.set_version_flag("--version", std::string("driftlabd " DRIFTLAB_VERSION));
  app.fallthrough();  // --data may stand behind a subcommand
  Settings settings;
  add_settings(app, settings);
  driftlab::server::AccessCommands access(app);
  const CLI::App* const crash_points =
      app.add_subcommand("crash-points", "List the points where tests may kill the daemon");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool wanted = error.get_exit_code() == 0;  // --help, --version
    app.exit(error);
    return wanted ? 0 : 2;
  }
  if (crash_points->parsed()) {
    for (const std::string_view name : driftlab::server::crash_point_names()) {
      std::printf("%.*s\n", static_cast<int>(name.size()), name.data());
    }
    return 0;
  }
  if (access.parsed()) {
    return access.run(settings);
  }
  return serve(settings);
}
