#pragma once
/// Connections to a PostgreSQL database, by libpq.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/sql/connection.hpp"

#include <libpq-fe.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace driftlab::server {

struct ResultDeleter {
  void operator()(PGresult* result) const { PQclear(result); }
};
using PostgresResult = std::unique_ptr<PGresult, ResultDeleter>;

/// A value as it is bound: its type decides which of the prepared forms of a text is run.
struct BoundValue {
  Oid type = 0;  ///< 0 for NULL: the server finds it out
  std::string text;
};

class PostgresConnection final : public Connection {
 public:
  /// Connects to `uri`, postgresql://USER@HOST:PORT/DATABASE?... of libpq. Defaults for what `uri` does not set: 5 s to
  /// connect, 15 s until a silent peer counts as gone, 30 s for a statement, 10 s for a lock, 60 s for a transaction in
  /// which nothing happens. Errors, each in one sentence: Io (no answer, no right to log in), Conflict (a server
  /// before version 15, another encoding than UTF-8), InvalidArgument (no connection string).
  [[nodiscard]] static Result<std::unique_ptr<PostgresConnection>> open(const std::string& uri,
                                                                        const std::string& application);
  PostgresConnection(const PostgresConnection&) = delete;
  PostgresConnection& operator=(const PostgresConnection&) = delete;
  ~PostgresConnection() override;

  /// Runs one or more statements without values, for migrations and transactions. The last one's result.
  [[nodiscard]] Result<PostgresResult> execute(const std::string& sql);
  /// Begins a transaction by `sql` and takes the server's time, both in one message.
  [[nodiscard]] Status begin(std::string_view sql);
  [[nodiscard]] Status commit();
  /// Undoes what was done since `begin`.
  void roll_back();

  /// What was notified of on the channels that this connection listens on; waits `longest` for the first. Error: Io.
  [[nodiscard]] Result<std::vector<std::string>> notifications(std::chrono::milliseconds longest);

  /// The server's clock at `begin`.
  [[nodiscard]] UtcMicros begun_at() const { return begun_at_; }
  /// The SQLSTATE of the first statement that failed since `begin`; empty: none did. 08006 where the connection broke.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// No statement can be run any more.
  [[nodiscard]] bool is_broken() const { return lost_ || PQstatus(handle_) != CONNECTION_OK; }
  [[nodiscard]] int server_version() const { return PQserverVersion(handle_); }
  /// `"driftlab" on db.example:5432`; never a password.
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] int changes() const override { return changes_; }
  [[nodiscard]] Engine engine() const override { return Engine::Postgres; }

  /// Runs a text with its values: prepared at the first time, and kept.
  [[nodiscard]] Result<PostgresResult> run(const std::string& sql, const std::vector<BoundValue>& values);

 private:
  explicit PostgresConnection(PGconn* handle) : handle_(handle) {}
  [[nodiscard]] Status check_server() const;
  [[nodiscard]] Result<std::string> prepared(const std::string& sql, const std::vector<BoundValue>& values);
  [[nodiscard]] Result<PostgresResult> accept(PostgresResult result);
  [[nodiscard]] std::unique_ptr<EngineStatement> make_statement(std::string_view sql) override;

  PGconn* handle_;
  bool lost_ = false;  ///< a statement said so
  std::string name_;
  std::string failure_;
  UtcMicros begun_at_ = 0;
  int changes_ = 0;
  std::unordered_map<std::string, std::string> prepared_;  ///< text and types: name
};

/// `?` and `?3` outside of literals as `$1` and `$3`. A text uses one of the two.
[[nodiscard]] std::string numbered_parameters(std::string_view sql);

/// What a failed statement means: code and sentence. `reason`: as the server or libpq put it.
[[nodiscard]] Error postgres_error(std::string_view sqlstate, const std::string& reason, const std::string& database);

}  // namespace driftlab::server
