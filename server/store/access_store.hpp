#pragma once
/// The store's records of access: tokens, the sessions of dashboards, and the audit log.
///
/// Secrets are kept as SHA-256 only: they are random and long, so that no slow hash is needed. Every change of a token
/// is a row of the audit log, written in its transaction. Methods are thread safe and may block on disk; every one may
/// fail with ErrorCode::Io or DiskFull.
#include "core/signal/result.hpp"
#include "server/store/audit.hpp"
#include "server/store/principal.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

struct Token {
  std::string id;  ///< eight characters, public: what logs and the audit log name
  std::string name;
  Scope scope = Scope::Read;
  std::optional<std::vector<std::string>> devices;  ///< names; nothing: every device
  std::string secret_sha256;
  UtcMicros created_at = 0;
  std::optional<UtcMicros> expires_at;
  std::optional<UtcMicros> revoked_at;
  std::optional<UtcMicros> rotated_at;
  std::optional<UtcMicros> last_used_at;  ///< to the minute
  bool is_damaged = false;                ///< its row is not what was written: it lets nobody in
};

struct Session {
  std::string secret_sha256;
  std::string token;
  UtcMicros created_at = 0;
  UtcMicros expires_at = 0;
};

class AccessStore {
 public:
  AccessStore() = default;
  AccessStore(const AccessStore&) = delete;
  AccessStore& operator=(const AccessStore&) = delete;
  virtual ~AccessStore() = default;

  /// Every token that ever was, oldest first: a revoked one stays as a row.
  [[nodiscard]] virtual Result<std::vector<Token>> tokens() = 0;
  [[nodiscard]] virtual Result<Token> add_token(const Token& token) = 0;
  /// Ends the token and its sessions, also where its row is damaged. NotFound. A token that is revoked already stays as
  /// it is.
  [[nodiscard]] virtual Result<Token> revoke_token(std::string_view id) = 0;
  /// Another secret for the same token; its sessions end. NotFound; Conflict where it is revoked;
  /// damaged_row (damaged_row.hpp) where it is damaged.
  [[nodiscard]] virtual Result<Token> rotate_token(std::string_view id, std::string_view secret_sha256) = 0;
  /// When tokens were last used. No row of the audit log.
  [[nodiscard]] virtual Status note_use(const std::vector<std::pair<std::string, UtcMicros>>& uses) = 0;

  /// Those that have not expired.
  [[nodiscard]] virtual Result<std::vector<Session>> sessions() = 0;
  /// Adds a session and forgets expired ones; of a token with more than 50 the oldest end.
  [[nodiscard]] virtual Status open_session(const Session& session) = 0;
  [[nodiscard]] virtual Status close_session(std::string_view secret_sha256) = 0;

  /// A row of the audit log about the daemon itself, whose actor is `daemon`.
  [[nodiscard]] virtual Status note_state(const std::string& action, const std::string& object,
                                          const std::string& detail) = 0;
  /// Rows of the audit log after (newest first: before) a sequence, 0 for the first page.
  [[nodiscard]] virtual Result<std::vector<AuditRow>> audit(std::int64_t after, int limit, bool newest_first) = 0;
  /// Reads the whole chain.
  [[nodiscard]] virtual Result<AuditVerdict> verify_audit() = 0;
};

}  // namespace driftlab::server
