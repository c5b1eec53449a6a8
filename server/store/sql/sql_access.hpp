#pragma once
/// The access store on the transactions of a database, and the rows of the audit log that both write.
#include "server/store/sql/access_tables.hpp"
#include "server/store/sql/database.hpp"

#include <functional>

namespace driftlab::server {

/// Told of every row of the audit log once it is durable. On the thread that made the change.
using AuditListener = std::function<void(const AuditRow&)>;

/// Writes of a caller: the change and the row of the audit log that says so, in one transaction.
class AuditedWriter {
 public:
  AuditedWriter(Database& database, AuditListener listener) : database_(database), listener_(std::move(listener)) {}

  /// Runs `work(connection)`, which gives a `Result`. Where this thread acts for a caller and `entry_of(outcome)` says
  /// that something changed, the row is written with it. Without a caller no row is written.
  template <class Work, class EntryOf>
  [[nodiscard]] auto write(Work work, EntryOf entry_of) {
    const Caller* const caller = caller_of_thread();
    std::optional<AuditRow> row;
    const WriteKind kind = caller == nullptr ? WriteKind::Serial : WriteKind::Audited;
    auto outcome = database_.write(kind, [&](Connection& connection) {
      auto made = work(connection);
      row.reset();
      if (!made || caller == nullptr) {
        return made;
      }
      const std::optional<tables::AuditEntry> entry = entry_of(*made);
      if (!entry) {
        return made;
      }
      auto appended = tables::append_audit(connection, *caller, *entry, database_.now(connection));
      if (!appended) {
        made = fail(appended.error());
      } else {
        row = std::move(*appended);
      }
      return made;
    });
    if (outcome && row && listener_) {
      listener_(*row);
    }
    return outcome;
  }

 private:
  Database& database_;
  AuditListener listener_;
};

class SqlAccess final : public AccessStore {
 public:
  SqlAccess(Database& database, AuditedWriter& audited) : database_(database), audited_(audited) {}

  [[nodiscard]] Result<std::vector<Token>> tokens() override;
  [[nodiscard]] Result<Token> add_token(const Token& token) override;
  [[nodiscard]] Result<Token> revoke_token(std::string_view id) override;
  [[nodiscard]] Result<Token> rotate_token(std::string_view id, std::string_view secret_sha256) override;
  [[nodiscard]] Status note_use(const std::vector<std::pair<std::string, UtcMicros>>& uses) override;
  [[nodiscard]] Result<std::vector<Session>> sessions() override;
  [[nodiscard]] Status open_session(const Session& session) override;
  [[nodiscard]] Status close_session(std::string_view secret_sha256) override;
  [[nodiscard]] Status note_state(const std::string& action, const std::string& object,
                                  const std::string& detail) override;
  [[nodiscard]] Result<std::vector<AuditRow>> audit(std::int64_t after, int limit, bool newest_first) override;
  [[nodiscard]] Result<AuditVerdict> verify_audit() override;

 private:
  Database& database_;
  AuditedWriter& audited_;
};

}  // namespace driftlab::server
