#include "server/store/postgres/connection.hpp"

#include "server/store/postgres/text_codec.hpp"

#include <poll.h>

#include <array>
#include <charconv>
#include <cstring>

namespace driftlab::server {
namespace {

// Types by their numbers in pg_type.dat, which are part of the protocol.
constexpr Oid kBigint = 20;
constexpr Oid kText = 25;
constexpr Oid kDoublePrecision = 701;
constexpr int kLeastServer = 150000;
/// The server too ends what a silent peer holds. What was acknowledged survives power loss: a database that is set to
/// forget it for speed is overruled.
constexpr const char* kSettings =
    "SET statement_timeout = 30000; SET lock_timeout = 10000; SET idle_in_transaction_session_timeout = 60000; "
    "SET client_min_messages = warning; SET standard_conforming_strings = on; SET tcp_keepalives_idle = 10; "
    "SET tcp_keepalives_interval = 5; SET tcp_keepalives_count = 3; SET tcp_user_timeout = 15000; "
    "SET jit = off; "  // compiling takes 20 ms and more of a query that reads a page
    "SELECT set_config('synchronous_commit', 'on', false) WHERE current_setting('synchronous_commit') = 'off'";
constexpr const char* kTime = "; SELECT (extract(epoch FROM clock_timestamp()) * 1000000)::BIGINT";
constexpr const char* kConnectionLost = "08006";

/// The server ended the connection, or libpq itself gave up (it states no code). Its status may still say that all is
/// well: the end of the stream is seen by the next read.
bool is_lost(std::string_view sqlstate) {
  return sqlstate.starts_with("08") || sqlstate == "57P01" || sqlstate == "57P02" || sqlstate == "57P03";
}

void ignore_notice(void* /*unused*/, const PGresult* /*unused*/) {}

template <class Number>
Number number_in(const char* text, int length) {
  Number value = 0;
  (void)std::from_chars(text, text + length, value);
  return value;
}

/// Rows of the whole result are in memory once it is run.
class PostgresStatement final : public EngineStatement {
 public:
  PostgresStatement(PostgresConnection& connection, std::string_view sql) : connection_(connection), sql_(sql) {}

  void bind_integer(std::int64_t value) override { values_.push_back({kBigint, std::to_string(value)}); }
  void bind_real(double value) override {
    std::array<char, 32> text{};  // the shortest text of a double has 24 characters at most
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    values_.push_back({kDoublePrecision, std::string(text.data(), written.ptr)});
  }
  void bind_text(std::string_view value) override { values_.push_back({kText, encode_text(value)}); }
  void bind_null() override { values_.push_back({0, {}}); }

  [[nodiscard]] Result<bool> step() override {
    if (!result_) {
      auto result = connection_.run({std::move(sql_), std::move(values_)});
      if (!result) {
        return fail(result.error());
      }
      result_ = std::move(*result);
    } else {
      ++row_;
    }
    return row_ < PQntuples(result_.get());
  }

  [[nodiscard]] Status run() override { return connection_.run_for_no_rows({std::move(sql_), std::move(values_)}); }

  [[nodiscard]] std::int64_t integer(int column) const override {
    return number_in<std::int64_t>(PQgetvalue(result_.get(), row_, column), PQgetlength(result_.get(), row_, column));
  }
  [[nodiscard]] double real(int column) const override {
    return number_in<double>(PQgetvalue(result_.get(), row_, column), PQgetlength(result_.get(), row_, column));
  }
  [[nodiscard]] std::string text(int column) const override {
    const auto length = static_cast<std::size_t>(PQgetlength(result_.get(), row_, column));
    return decode_text({PQgetvalue(result_.get(), row_, column), length});
  }
  [[nodiscard]] bool is_null(int column) const override { return PQgetisnull(result_.get(), row_, column) != 0; }

 private:
  PostgresConnection& connection_;
  std::string sql_;
  std::vector<BoundValue> values_;
  PostgresResult result_;
  int row_ = 0;
};

/// libpq's own reason is not told: it may quote the password.
bool is_connection_string(const std::string& uri) {
  char* reason = nullptr;
  PQconninfoOption* const options = PQconninfoParse(uri.c_str(), &reason);
  const bool sound = options != nullptr;
  PQconninfoFree(options);
  PQfreemem(reason);
  return sound;
}

std::string described(const PGconn* handle) {
  const auto text = [](const char* value) { return std::string(value == nullptr ? "" : value); };
  const std::string host = text(PQhost(handle));
  const std::string name = "\"" + text(PQdb(handle)) + "\" on " + (host.empty() ? "this machine" : host);
  const std::string port = text(PQport(handle));
  return host.empty() || port.empty() ? name : name + ":" + port;
}

}  // namespace

std::string numbered_parameters(std::string_view sql) {
  std::string numbered;
  int next = 0;
  bool in_literal = false;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    const char letter = sql[i];
    in_literal = letter == '\'' ? !in_literal : in_literal;
    if (letter != '?' || in_literal) {
      numbered.push_back(letter);
      continue;
    }
    numbered.push_back('$');
    const bool has_number = i + 1 < sql.size() && sql[i + 1] >= '0' && sql[i + 1] <= '9';
    if (!has_number) {
      numbered.append(std::to_string(++next));
    }
  }
  return numbered;
}

Result<std::unique_ptr<PostgresConnection>> PostgresConnection::open(const std::string& uri,
                                                                     const std::string& application) {
  if (!is_connection_string(uri)) {
    return fail(ErrorCode::InvalidArgument,
                "The store is written postgresql://USER@HOST:PORT/DATABASE, with parameters of libpq behind a '?'.",
                {{"parameter", "store"}});
  }
  // What stands before the connection string holds where that says nothing else.
  const std::array<const char*, 10> names = {"connect_timeout",     "keepalives_idle",
                                             "keepalives_interval", "keepalives_count",
                                             "tcp_user_timeout",    "gssencmode",
                                             "application_name",    "dbname",
                                             "client_encoding",     nullptr};
  const std::array<const char*, 10> values = {"5",         "10",   "5",    "3", "15000", "disable", application.c_str(),
                                              uri.c_str(), "UTF8", nullptr};
  std::unique_ptr<PostgresConnection> connection(
      new PostgresConnection(PQconnectdbParams(names.data(), values.data(), 1)));
  PGconn* const handle = connection->handle_;
  connection->name_ = described(handle);
  if (connection->is_broken()) {
    return fail(
        postgres_error("08001", handle == nullptr ? "out of memory" : PQerrorMessage(handle), connection->name_));
  }
  (void)PQsetNoticeReceiver(handle, ignore_notice, nullptr);
  if (Status fits = connection->check_server(); !fits) {
    return fail(fits.error());
  }
  if (auto set = connection->execute(kSettings); !set) {
    return fail(set.error());
  }
  return connection;
}

Status PostgresConnection::check_server() const {
  const std::vector<ErrorField> fields = {{"database", name_}};
  if (const int version = server_version(); version < kLeastServer) {
    return fail(ErrorCode::Conflict,
                "The database " + name_ + " is served by PostgreSQL " + std::to_string(version / 10000) +
                    "; driftlab needs version 15 or a later one.",
                fields);
  }
  const char* const encoding = PQparameterStatus(handle_, "server_encoding");
  if (encoding == nullptr || std::strcmp(encoding, "UTF8") != 0) {
    return fail(ErrorCode::Conflict,
                "The database " + name_ + " has the encoding " + (encoding == nullptr ? "?" : encoding) +
                    "; driftlab needs UTF8.",
                fields);
  }
  return {};
}

PostgresConnection::~PostgresConnection() { PQfinish(handle_); }

Result<PostgresResult> PostgresConnection::accept(PostgresResult result) {
  const ExecStatusType status = PQresultStatus(result.get());
  if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) {
    return result;
  }
  const char* const given = result ? PQresultErrorField(result.get(), PG_DIAG_SQLSTATE) : nullptr;
  const std::string state = given != nullptr ? given : kConnectionLost;
  lost_ = lost_ || is_lost(state);
  const char* const primary = result ? PQresultErrorField(result.get(), PG_DIAG_MESSAGE_PRIMARY) : nullptr;
  if (failure_.empty()) {
    failure_ = state;
  }
  return fail(postgres_error(state, primary != nullptr ? primary : PQerrorMessage(handle_), name_));
}

Result<PostgresResult> PostgresConnection::execute(const std::string& sql) {
  return accept(PostgresResult(PQexec(handle_, sql.c_str())));
}

Status PostgresConnection::begin(std::string_view sql) {
  failure_.clear();
  held_failure_.reset();
  const auto result = execute(std::string(sql) + kTime);
  if (!result) {
    return fail(result.error());
  }
  begun_at_ = number_in<UtcMicros>(PQgetvalue(result->get(), 0, 0), PQgetlength(result->get(), 0, 0));
  return {};
}

Status PostgresConnection::commit() {
  // COMMIT of a transaction in which a statement failed is a ROLLBACK, and no error.
  if (PQtransactionStatus(handle_) != PQTRANS_INTRANS || !held_.empty()) {
    return fail(ErrorCode::Internal, "A transaction ended before its time.");
  }
  const auto result = execute("COMMIT");
  return result ? Status{} : fail(result.error());
}

void PostgresConnection::end_read() { lost_ = lost_ || PQsendQuery(handle_, "COMMIT") != 1; }

void PostgresConnection::roll_back() {
  holds_ = false;
  held_.clear();
  held_bytes_ = 0;
  if (PQtransactionStatus(handle_) != PQTRANS_IDLE && !is_broken()) {
    const std::string failure = failure_;
    (void)execute("ROLLBACK");
    failure_ = failure;
  }
}

Result<std::vector<std::string>> PostgresConnection::notifications(std::chrono::milliseconds longest) {
  std::vector<std::string> payloads;
  const auto take = [&] {
    while (PGnotify* const notice = PQnotifies(handle_)) {
      payloads.emplace_back(decode_text(notice->extra));
      PQfreemem(notice);
    }
  };
  take();
  if (payloads.empty()) {
    ::pollfd waiting{PQsocket(handle_), POLLIN, 0};
    if (waiting.fd >= 0 && ::poll(&waiting, 1, static_cast<int>(longest.count())) > 0 && PQconsumeInput(handle_) == 0) {
      return fail(postgres_error(kConnectionLost, PQerrorMessage(handle_), name_));
    }
    take();
  }
  if (is_broken()) {
    return fail(postgres_error(kConnectionLost, PQerrorMessage(handle_), name_));
  }
  return payloads;
}

std::unique_ptr<EngineStatement> PostgresConnection::make_statement(std::string_view sql) {
  return std::make_unique<PostgresStatement>(*this, sql);
}

}  // namespace driftlab::server
