#include "tests/unit/store/postgres/cluster.hpp"

#include <fcntl.h>
#include <grp.h>
#include <libpq-fe.h>
#include <pwd.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <vector>

namespace driftlab::server {
namespace {

constexpr std::chrono::seconds kPatience{60};

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "The PostgreSQL of the tests: %s\n", why.c_str());
  std::abort();
}

/// Whoever owns the cluster: user and group; root's is `postgres`.
struct Owner {
  uid_t user = ::getuid();
  gid_t group = ::getgid();
};

Owner find_owner() {
  Owner owner;
  if (owner.user == 0) {
    std::array<char, 4096> buffer{};
    passwd entry{};
    passwd* found = nullptr;
    if (::getpwnam_r("postgres", &entry, buffer.data(), buffer.size(), &found) != 0 || found == nullptr) {
      give_up("there is no user postgres");
    }
    owner = {found->pw_uid, found->pw_gid};
  }
  return owner;
}

/// Starts a program as the owner. It is killed with this process; its output goes to `log`.
pid_t start_program(const std::vector<std::string>& command, const std::filesystem::path& log) {
  const Owner owner = find_owner();
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& part : command) {
    arguments.push_back(const_cast<char*>(part.c_str()));
  }
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child != 0) {
    return child;
  }
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  (void)::dup2(output, STDOUT_FILENO);
  (void)::dup2(output, STDERR_FILENO);
  const bool changed =
      ::getuid() != 0 || (::setgroups(0, nullptr) == 0 && ::setgid(owner.group) == 0 && ::setuid(owner.user) == 0);
  (void)::prctl(PR_SET_PDEATHSIG, SIGQUIT);
  if (changed && ::getppid() == parent) {
    (void)::execv(arguments.front(), arguments.data());
  }
  ::_exit(127);
}

bool is_up(const std::string& uri) { return PQping(uri.c_str()) == PQPING_OK; }

}  // namespace

std::filesystem::path PostgresCluster::programs() {
  for (int version = 25; version >= 15; --version) {
    const auto folder = std::filesystem::path("/usr/lib/postgresql") / std::to_string(version) / "bin";
    std::error_code none;
    if (std::filesystem::exists(folder / "initdb", none)) {
      return folder;
    }
  }
  return {};
}

PostgresCluster& PostgresCluster::of_this_process() {
  static PostgresCluster cluster;
  return cluster;
}

PostgresCluster::PostgresCluster() {
  std::string name = (std::filesystem::temp_directory_path() / "driftlab-postgres-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    give_up("no temporary folder");
  }
  directory_ = name;
  const Owner owner = find_owner();
  if (::chown(directory_.c_str(), owner.user, owner.group) != 0) {
    give_up("the temporary folder cannot be handed over");
  }
  const pid_t made =
      start_program({programs() / "initdb", "--pgdata=" + (directory_ / "data").string(), "--username=driftlab",
                     "--auth=trust", "--encoding=UTF8", "--locale=C.UTF-8", "--no-sync"},
                    directory_ / "log");
  int status = -1;
  if (::waitpid(made, &status, 0) != made || status != 0) {
    give_up("initdb failed, see " + (directory_ / "log").string());
  }
  start();
}

PostgresCluster::~PostgresCluster() {
  stop(SIGQUIT);
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

void PostgresCluster::start() {
  server_ = start_program({programs() / "postgres", "-D", (directory_ / "data").string(), "-k", directory_.string(),
                           "-c", "listen_addresses=", "-c", "fsync=off", "-c", "max_connections=80"},
                          directory_ / "log");
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!is_up(uri("public"))) {
    if (std::chrono::steady_clock::now() > deadline) {
      give_up("it does not start, see " + (directory_ / "log").string());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void PostgresCluster::stop(int signal) {
  if (server_ > 0) {
    (void)::kill(server_, signal);
    int status = 0;
    (void)::waitpid(server_, &status, 0);
    server_ = -1;
  }
}

std::string PostgresCluster::uri(const std::string& schema, const std::string& user,
                                 const std::string& parameters) const {
  return "postgresql:///postgres?user=" + user + "&host=" + directory_.string() + "&options=-csearch_path%3D" + schema +
         parameters;
}

std::string PostgresCluster::schema(const std::string& name) const {
  if (!run("CREATE SCHEMA IF NOT EXISTS " + name)) {
    give_up("no schema " + name);
  }
  return uri(name);
}

bool PostgresCluster::cut_connections() const {
  return run("SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity WHERE application_name = 'driftlabd'");
}

bool PostgresCluster::run(const std::string& sql) const {
  // Also where a test has made the database read-only.
  PGconn* const connection = PQconnectdb(uri("public%20-cdefault_transaction_read_only%3Doff").c_str());
  (void)PQsetNoticeReceiver(connection, [](void*, const PGresult*) {}, nullptr);
  PGresult* const result = PQexec(connection, sql.c_str());
  const ExecStatusType status = PQresultStatus(result);
  const bool done = status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK;
  if (!done) {
    std::fprintf(stderr, "%s", PQerrorMessage(connection));
  }
  PQclear(result);
  PQfinish(connection);
  return done;
}

}  // namespace driftlab::server
