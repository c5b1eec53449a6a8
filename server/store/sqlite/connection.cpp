#include "server/store/sqlite/connection.hpp"

#include <cerrno>

namespace driftlab::server {

namespace {

/// On loan from its connection; goes back (reset, bindings cleared) when this object dies.
class SqliteStatement final : public EngineStatement {
 public:
  SqliteStatement(const SqliteConnection& connection, sqlite3_stmt* statement, int status)
      : connection_(connection), statement_(statement), status_(status) {}
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;
  ~SqliteStatement() override {
    if (statement_ != nullptr) {
      (void)sqlite3_reset(statement_);
      (void)sqlite3_clear_bindings(statement_);
    }
  }

  void bind_integer(std::int64_t value) override {
    if (status_ == SQLITE_OK) {
      status_ = sqlite3_bind_int64(statement_, ++bound_, value);
    }
  }
  void bind_real(double value) override {
    if (status_ == SQLITE_OK) {
      status_ = sqlite3_bind_double(statement_, ++bound_, value);
    }
  }
  void bind_text(std::string_view value) override {
    if (status_ == SQLITE_OK) {
      // SQLite copies the text; an empty view may have no address, and a null address would bind NULL.
      const char* address = value.empty() ? "" : value.data();
      status_ = sqlite3_bind_text64(statement_, ++bound_, address, value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
  }
  void bind_null() override {
    if (status_ == SQLITE_OK) {
      status_ = sqlite3_bind_null(statement_, ++bound_);
    }
  }

  [[nodiscard]] Result<bool> step() override {
    if (status_ != SQLITE_OK) {
      return fail(connection_.error(status_));
    }
    const int status = sqlite3_step(statement_);
    if (status == SQLITE_ROW) {
      return true;
    }
    if (status == SQLITE_DONE) {
      return false;
    }
    return fail(connection_.error(status));
  }

  [[nodiscard]] std::int64_t integer(int column) const override { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] double real(int column) const override { return sqlite3_column_double(statement_, column); }
  [[nodiscard]] std::string text(int column) const override {
    const unsigned char* bytes = sqlite3_column_text(statement_, column);
    const int size = sqlite3_column_bytes(statement_, column);
    return bytes == nullptr ? std::string()
                            : std::string(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  }
  [[nodiscard]] bool is_null(int column) const override {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
  }

 private:
  const SqliteConnection& connection_;
  sqlite3_stmt* statement_;
  int status_;
  int bound_ = 0;
};

}  // namespace

Result<std::unique_ptr<SqliteConnection>> SqliteConnection::open(const std::filesystem::path& path, Access access) {
  const int mode = access == Access::ReadOnly ? SQLITE_OPEN_READONLY : (SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  sqlite3* handle = nullptr;
  const int status =
      sqlite3_open_v2(path.c_str(), &handle, mode | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  std::unique_ptr<SqliteConnection> connection(new SqliteConnection(handle, path));
  if (status != SQLITE_OK) {
    return fail(connection->error(status));
  }
  if (Status configured = connection->configure(access); !configured) {
    return fail(configured.error());
  }
  return connection;
}

Status SqliteConnection::configure(Access access) {
  (void)sqlite3_busy_timeout(handle_, 5000);
  (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
  (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  // Pages that were read stay in the system's cache anyway; a cache of each connection beside it, 2 MiB unless told
  // otherwise, only makes the process grow with the database.
  const char* common = "PRAGMA mmap_size=0; PRAGMA cell_size_check=ON; PRAGMA foreign_keys=ON; PRAGMA cache_size=-512;";
  if (Status done = execute(common); !done || access == Access::ReadOnly) {
    return done;
  }
  const Result<std::optional<std::string>> mode = query_text("PRAGMA journal_mode=WAL");
  if (!mode) {
    return fail(mode.error());
  }
  if (mode->value_or("") != "wal") {
    return fail(ErrorCode::Io, "The file system of " + path_.string() + " cannot keep a write-ahead log.",
                {{"path", path_.string()}});
  }
  return execute("PRAGMA synchronous=FULL;");
}

SqliteConnection::~SqliteConnection() {
  for (const auto& [sql, statement] : statements_) {
    (void)sqlite3_finalize(statement);
  }
  (void)sqlite3_close(handle_);
}

std::unique_ptr<EngineStatement> SqliteConnection::make_statement(std::string_view sql) {
  std::string text(sql);
  const auto kept = statements_.find(text);
  if (kept != statements_.end()) {
    return std::make_unique<SqliteStatement>(*this, kept->second, SQLITE_OK);
  }
  sqlite3_stmt* statement = nullptr;
  const int status = sqlite3_prepare_v3(handle_, text.data(), static_cast<int>(text.size()), SQLITE_PREPARE_PERSISTENT,
                                        &statement, nullptr);
  if (status == SQLITE_OK) {
    statements_.emplace(std::move(text), statement);
  }
  return std::make_unique<SqliteStatement>(*this, statement, status);
}

Status SqliteConnection::execute(const std::string& sql) {
  const int status = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  return status == SQLITE_OK ? Status{} : fail(error(status));
}

Error SqliteConnection::error(int status) const {
  const int primary = status & 0xFF;
  const std::string reason = handle_ == nullptr ? sqlite3_errstr(status) : sqlite3_errmsg(handle_);
  const std::vector<ErrorField> fields = {{"path", path_.string()}};
  const int system = handle_ == nullptr ? 0 : sqlite3_system_errno(handle_);
  const bool full = system == ENOSPC || system == EDQUOT || system == EFBIG;
  if (primary == SQLITE_FULL || (primary == SQLITE_IOERR && full)) {
    return {ErrorCode::DiskFull, "The disk that holds " + path_.string() + " is full.", fields};
  }
  if (primary == SQLITE_CONSTRAINT || primary == SQLITE_MISUSE || primary == SQLITE_ERROR || primary == SQLITE_RANGE) {
    return {ErrorCode::Internal, "The database refused a statement: " + reason + ".", fields};
  }
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB) {
    return {ErrorCode::Io, "The file " + path_.string() + " is damaged or is no database: " + reason + ".", fields};
  }
  return {ErrorCode::Io, "The database " + path_.string() + " could not be read or written: " + reason + ".", fields};
}

}  // namespace driftlab::server
