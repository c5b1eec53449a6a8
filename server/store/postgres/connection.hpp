#pragma once
/// Connections to a PostgreSQL database, by libpq.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/sql/connection.hpp"

#include <libpq-fe.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

/// A text with its values.
struct BoundStatement {
  std::string sql;
  std::vector<BoundValue> values;
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
  /// From now on until the transaction ends, what is to run without giving rows is held back: it is sent with the next
  /// statement that gives rows, by `changes`, by `settle`, or once it is much. All of it together is one message and
  /// one wait.
  void hold_runs() { holds_ = true; }
  /// Sends what is held back. The outcome of the transaction's work: `outcome`, unless what was held back failed.
  [[nodiscard]] Status settle(Status outcome = {});
  /// After `settle`: what is still held back is no part of the transaction.
  [[nodiscard]] Status commit();
  /// Ends a transaction that wrote nothing. What the server says to that is read when the next one begins.
  void end_read();
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

  [[nodiscard]] int changes() override { return settle() ? changes_ : 0; }
  [[nodiscard]] Engine engine() const override { return Engine::Postgres; }

  /// Runs a text with its values behind what is held back: prepared at the first time, and kept.
  [[nodiscard]] Result<PostgresResult> run(BoundStatement statement);
  /// The same, without its rows; held back where that was asked for.
  [[nodiscard]] Status run_for_no_rows(BoundStatement statement);

 private:
  explicit PostgresConnection(PGconn* handle) : handle_(handle) {}
  [[nodiscard]] Status check_server() const;
  [[nodiscard]] Result<PostgresResult> accept(PostgresResult result);
  [[nodiscard]] Result<PostgresResult> accept_run(PostgresResult result);
  /// What the server is to answer next: that a statement is prepared, or its result.
  struct Expected {
    std::size_t statement = 0;
    std::string prepares;  ///< text and types; empty: it is run
    std::string name;
  };
  [[nodiscard]] Error lose(const std::string& reason);
  [[nodiscard]] std::optional<std::vector<Expected>> send_together(std::span<const BoundStatement> statements);
  [[nodiscard]] PostgresResult next_result();
  [[nodiscard]] Result<PostgresResult> run_together(std::span<const BoundStatement> statements, std::size_t held);
  [[nodiscard]] std::unique_ptr<EngineStatement> make_statement(std::string_view sql) override;

  PGconn* handle_;
  bool lost_ = false;  ///< a statement said so
  std::string name_;
  std::string failure_;
  UtcMicros begun_at_ = 0;
  int changes_ = 0;
  std::unordered_map<std::string, std::string> prepared_;  ///< text and types: name
  std::uint64_t names_ = 0;                                ///< of prepared statements that were given
  bool holds_ = false;
  std::vector<BoundStatement> held_;
  std::size_t held_bytes_ = 0;
  std::optional<Error> held_failure_;  ///< of the first statement since `begin` that failed after it was held back
};

/// `?` and `?3` outside of literals as `$1` and `$3`. A text uses one of the two.
[[nodiscard]] std::string numbered_parameters(std::string_view sql);

/// What a failed statement means: code and sentence. `reason`: as the server or libpq put it.
[[nodiscard]] Error postgres_error(std::string_view sqlstate, const std::string& reason, const std::string& database);

}  // namespace driftlab::server
