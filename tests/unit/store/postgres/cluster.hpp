#pragma once
/// A PostgreSQL server of the test's own: a cluster in a temporary folder, reached by a socket in it alone.
///
/// initdb refuses root, so that the server then runs as the user `postgres` of Debian's package. It ends with the test,
/// also where that is killed. It does not wait for the disk: what a power cut leaves is the subject of other tests.
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>

namespace driftlab::server {

class PostgresCluster {
 public:
  /// The programs of PostgreSQL 15 or later, /usr/lib/postgresql/N/bin; empty: it is not installed.
  [[nodiscard]] static std::filesystem::path programs();
  /// That of this process, started when it is first asked for. It aborts where it cannot be started.
  [[nodiscard]] static PostgresCluster& of_this_process();

  PostgresCluster();
  PostgresCluster(const PostgresCluster&) = delete;
  PostgresCluster& operator=(const PostgresCluster&) = delete;
  ~PostgresCluster();

  /// The connection string of a schema, which is made where it is absent: tests do not see each other's tables.
  [[nodiscard]] std::string schema(const std::string& name) const;
  /// The same for another user or with more parameters, `&name=value`. Nothing is made.
  [[nodiscard]] std::string uri(const std::string& schema, const std::string& user = "driftlab",
                                const std::string& parameters = "") const;
  /// Runs statements as superuser. False: one failed.
  [[nodiscard]] bool run(const std::string& sql) const;
  /// Ends every connection of a daemon and waits until the server has let them go, so that no later statement is still
  /// begun on one of them; ten seconds at most for each. False: the server could not be asked.
  [[nodiscard]] bool cut_connections() const;
  void start();
  /// `signal`: SIGINT ends connections first, SIGQUIT does not.
  void stop(int signal);

 private:
  std::filesystem::path directory_;
  pid_t server_ = -1;
};

}  // namespace driftlab::server
