#pragma once
/// The access store on the connections of the SQLite store, and the rows of the audit log that both write.
#include "server/store/sqlite/access_tables.hpp"
#include "server/store/sqlite/reader_pool.hpp"
#include "server/store/sqlite/writer.hpp"

#include <functional>

namespace driftlab::server {

/// Told of every row of the audit log once it is durable. On the thread that made the change.
using AuditListener = std::function<void(const AuditRow&)>;

/// Writes of a caller: the change and the row of the audit log that says so, in one transaction.
class AuditedWriter {
 public:
  AuditedWriter(Writer& writer, const Clock& clock, AuditListener listener)
      : writer_(writer), clock_(clock), listener_(std::move(listener)) {}

  /// Runs `work(connection)`, which gives a `Result`. Where this thread acts for a caller and `entry_of(outcome)` says
  /// that something changed, the row is written with it. Where it acts for nobody nothing is.
  template <class Work, class EntryOf>
  [[nodiscard]] auto write(Work work, EntryOf entry_of) {
    const Caller* const caller = caller_of_thread();
    std::optional<AuditRow> row;
    auto outcome = writer_.write([&](Connection& connection) {
      auto made = work(connection);
      row.reset();
      if (!made || caller == nullptr) {
        return made;
      }
      const std::optional<tables::AuditEntry> entry = entry_of(*made);
      if (!entry) {
        return made;
      }
      auto appended = tables::append_audit(connection, *caller, *entry, clock_.now());
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
  Writer& writer_;
  const Clock& clock_;
  AuditListener listener_;
};

class SqliteAccess final : public AccessStore {
 public:
  SqliteAccess(Writer& writer, AuditedWriter& audited, ReaderPool& readers, const Clock& clock)
      : writer_(writer), audited_(audited), readers_(readers), clock_(clock) {}

  [[nodiscard]] Result<std::vector<Token>> tokens() override;
  [[nodiscard]] Result<Token> add_token(const Token& token) override;
  [[nodiscard]] Result<Token> revoke_token(std::string_view id) override;
  [[nodiscard]] Result<Token> rotate_token(std::string_view id, std::string_view secret_sha256) override;
  [[nodiscard]] Status note_use(const std::vector<std::pair<std::string, UtcMicros>>& uses) override;
  [[nodiscard]] Result<std::vector<Session>> sessions() override;
  [[nodiscard]] Status open_session(const Session& session) override;
  [[nodiscard]] Status close_session(std::string_view secret_sha256) override;
  [[nodiscard]] Result<std::vector<AuditRow>> audit(std::int64_t after, int limit, bool newest_first) override;
  [[nodiscard]] Result<AuditVerdict> verify_audit() override;

 private:
  Writer& writer_;
  AuditedWriter& audited_;
  ReaderPool& readers_;
  const Clock& clock_;
};

}  // namespace driftlab::server
