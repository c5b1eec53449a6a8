#pragma once
/// The gate: identifies the caller of each request and decides whether it is allowed.
///
/// Authentication is on once there ever was a token, or where the daemon was told to require one; before that everybody
/// who reaches the daemon may do everything, and the daemon listens on loopback alone. It never switches itself off:
/// with every token revoked, every request that needs one is refused.
///
/// Tokens and sessions are held in memory, so that the check costs a hash and no disk: it runs on I/O threads. Changes
/// are written to the store first. Thread safe.
#include "server/store/access_store.hpp"
#include "server/store/budgets.hpp"
#include "server/store/clock.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// What a request brings: the values of its headers, where it has them.
struct Credentials {
  std::optional<std::string_view> authorization;
  std::optional<std::string_view> cookie;
};

struct NewToken {
  std::string name;
  Scope scope = Scope::Read;
  std::optional<std::vector<std::string>> devices;
  std::optional<UtcMicros> expires_at;
};

/// A token with its secret, which is shown this once.
struct IssuedToken {
  Token token;
  std::string secret;
};

struct IssuedSession {
  Session session;
  std::string secret;
};

struct GateOptions {
  bool require = false;  ///< authentication is on even without a token
  bool secure = false;   ///< the daemon speaks TLS: cookies say so
  Budgets budgets = {};
};

class Gate {
 public:
  /// References must outlive the gate.
  Gate(AccessStore& store, const Clock& clock, GateOptions options);

  /// Reads tokens and sessions; to be called before anything else.
  [[nodiscard]] Status load();
  /// Whether authentication is on.
  [[nodiscard]] bool is_on() const;
  /// Whether there ever was a token.
  [[nodiscard]] bool has_any() const;
  /// Whether some token may administrate now.
  [[nodiscard]] bool has_admin() const;

  /// Who brings these credentials. Error: a sentence for whoever is not admitted, in `unexpected`.
  [[nodiscard]] tl::expected<Principal, std::string> identify(const Credentials& credentials);
  /// Whether that principal would be admitted still: its token is neither revoked nor expired, and the session that it
  /// came in by has not ended.
  [[nodiscard]] bool is_valid(const Principal& principal) const;

  /// Errors: InvalidArgument (name, devices of an admin, expiry in the past), Conflict (the first token must be an
  /// admin).
  [[nodiscard]] Result<IssuedToken> create(const NewToken& wanted);
  /// Errors: NotFound; Conflict for the last admin that lasts another day, unless `even_last`.
  [[nodiscard]] Result<Token> revoke(std::string_view id, bool even_last = false);
  /// Another secret for the same token. Errors: NotFound; Conflict where it was revoked or has expired.
  [[nodiscard]] Result<IssuedToken> rotate(std::string_view id);
  [[nodiscard]] Result<std::vector<Token>> tokens() { return store_.tokens(); }
  [[nodiscard]] bool is_secure() const { return options_.secure; }

  /// A session for whoever has the secret of a token, for 12 h at most. Error: forbidden.
  [[nodiscard]] Result<IssuedSession> open_session(std::string_view secret);
  [[nodiscard]] Status close_session(const Credentials& credentials);

  /// Writes when tokens were last used, once a minute at most or `now`. May block.
  [[nodiscard]] Status flush_use(bool now = false);

 private:
  struct Kept;
  [[nodiscard]] std::shared_ptr<const Kept> kept() const;
  [[nodiscard]] Status reload();
  [[nodiscard]] const Token* token_of_secret(const Kept& kept, std::string_view secret) const;
  void note_use(const std::string& token);

  AccessStore& store_;
  const Clock& clock_;
  const GateOptions options_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Kept> kept_;
  std::mutex changing_;                    ///< one change after the other, so that what is read after it is the newest
  std::map<std::string, UtcMicros> uses_;  ///< not yet written
  UtcMicros flushed_at_ = 0;
};

/// The cookie that holds a session's secret: with the prefix that binds it to host and TLS where the daemon has TLS.
[[nodiscard]] std::string_view session_cookie(bool secure);

}  // namespace driftlab::server
