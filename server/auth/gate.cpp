#include "server/auth/gate.hpp"

#include "core/signal/text.hpp"
#include "server/auth/secret.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <iterator>

namespace driftlab::server {
namespace {

constexpr UtcMicros kMinute = 60'000'000;
constexpr UtcMicros kSessionLifetime = UtcMicros{12} * 60 * kMinute;
constexpr UtcMicros kShortestOfLastAdmin = UtcMicros{24} * 60 * kMinute;
constexpr std::size_t kLongestName = 100;
constexpr std::size_t kMostDevices = 100;

bool is_live(const Token& token, UtcMicros now) {
  return !token.is_damaged && !token.revoked_at && (!token.expires_at || *token.expires_at > now);
}

Principal principal_of(const Token& token) { return {token.id, token.name, token.scope, token.devices, ""}; }

/// The value of the session cookie. Under TLS only that with the prefix counts, which no other host and no page of
/// plain HTTP can set.
std::optional<std::string_view> session_of(std::string_view cookies, bool secure) {
  for (const std::string_view pair : split(cookies, ';')) {
    const std::string_view cookie = trimmed(pair);
    const std::size_t equals = std::min(cookie.find('='), cookie.size());
    const std::string_view name = cookie.substr(0, equals);
    if (equals < cookie.size() && name == session_cookie(secure)) {
      return cookie.substr(equals + 1);
    }
  }
  return std::nullopt;
}

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

}  // namespace

struct Gate::Kept {
  std::vector<Token> tokens;
  std::vector<Session> sessions;

  [[nodiscard]] const Token* find(std::string_view id) const {
    const auto found = std::find_if(tokens.begin(), tokens.end(), [&](const Token& token) { return token.id == id; });
    return found == tokens.end() ? nullptr : &*found;
  }
};

std::string_view session_cookie(bool secure) { return secure ? "__Host-driftlab" : "driftlab-session"; }

Gate::Gate(AccessStore& store, const Clock& clock, GateOptions options)
    : store_(store), clock_(clock), options_(options), kept_(std::make_shared<Kept>()) {}

std::shared_ptr<const Gate::Kept> Gate::kept() const {
  const std::lock_guard lock(mutex_);
  return kept_;
}

Status Gate::load() {
  const std::lock_guard changing(changing_);
  return reload();
}

Status Gate::reload() {
  auto tokens = store_.tokens();
  if (!tokens) {
    return fail(tokens.error());
  }
  auto sessions = store_.sessions();
  if (!sessions) {
    return fail(sessions.error());
  }
  auto fresh = std::make_shared<const Kept>(Kept{std::move(*tokens), std::move(*sessions)});
  const std::lock_guard lock(mutex_);
  kept_ = std::move(fresh);
  return {};
}

bool Gate::is_on() const { return options_.require || !kept()->tokens.empty(); }

bool Gate::has_any() const { return !kept()->tokens.empty(); }

bool Gate::has_admin() const {
  const auto now = clock_.now();
  const auto all = kept();
  return std::any_of(all->tokens.begin(), all->tokens.end(),
                     [&](const Token& token) { return token.scope == Scope::Admin && is_live(token, now); });
}

const Token* Gate::token_of_secret(const Kept& all, std::string_view secret) const {
  const std::string digest = sha256_hex(secret);
  const Token* found = nullptr;
  for (const Token& token : all.tokens) {  // all of them, so that the time does not tell which
    if (is_same_digest(token.secret_sha256, digest)) {
      found = &token;
    }
  }
  return found;
}

tl::expected<Principal, std::string> Gate::identify(const Credentials& credentials) {
  const auto all = kept();
  if (!options_.require && all->tokens.empty()) {
    return Principal{};
  }
  const Token* token = nullptr;
  std::string by_session;
  if (credentials.authorization) {
    constexpr std::string_view kBearer = "bearer ";
    const std::string scheme = lower_case(credentials.authorization->substr(0, kBearer.size()));
    const std::string_view secret =
        scheme == kBearer ? trimmed(credentials.authorization->substr(kBearer.size())) : std::string_view{};
    if (!is_secret(secret)) {
      return tl::unexpected(
          std::string("Authorization is `Bearer` and a token, dl_ and 37 characters; this is none, or it has a "
                      "typing error."));
    }
    token = token_of_secret(*all, secret);
  } else if (const auto cookie = credentials.cookie ? session_of(*credentials.cookie, options_.secure) : std::nullopt) {
    const std::string digest = sha256_hex(*cookie);
    for (const Session& session : all->sessions) {
      if (is_same_digest(session.secret_sha256, digest) && session.expires_at > clock_.now()) {
        token = all->find(session.token);
        by_session = digest;
      }
    }
    if (token == nullptr) {
      return tl::unexpected(std::string("The session has ended; sign in again."));
    }
  } else {
    return tl::unexpected(std::string("This daemon asks for a token; send Authorization: Bearer TOKEN."));
  }
  if (token == nullptr || token->revoked_at) {
    return tl::unexpected(std::string("The token is not known here, or was revoked."));
  }
  if (token->is_damaged) {
    return tl::unexpected("The row of the token " + token->id +
                          " is damaged; an admin revokes it and makes another one.");
  }
  if (!is_live(*token, clock_.now())) {
    return tl::unexpected(std::string("The token has expired."));
  }
  note_use(token->id);
  Principal principal = principal_of(*token);
  principal.session = std::move(by_session);
  return principal;
}

bool Gate::is_valid(const Principal& principal) const {
  const auto all = kept();
  if (principal.token.empty()) {
    return !options_.require && all->tokens.empty();
  }
  const Token* const token = all->find(principal.token);
  const auto now = clock_.now();
  return token != nullptr && is_live(*token, now) &&
         (principal.session.empty() ||
          std::any_of(all->sessions.begin(), all->sessions.end(), [&](const Session& session) {
            return session.secret_sha256 == principal.session && session.expires_at > now;
          }));
}

Result<IssuedToken> Gate::create(const NewToken& wanted) {
  const std::lock_guard changing(changing_);
  const auto now = clock_.now();
  if (trimmed(wanted.name).empty() || wanted.name.size() > kLongestName || has_control(wanted.name)) {
    return fail(ErrorCode::InvalidArgument, "A token needs a name of at most 100 bytes without control characters.",
                {{"/name", "A name of 1 to 100 bytes."}});
  }
  if (wanted.scope == Scope::Public) {
    return fail(ErrorCode::InvalidArgument, "The scope of a token is read, write, run or admin.",
                {{"/scope", "read, write, run or admin."}});
  }
  if (wanted.devices &&
      (wanted.scope == Scope::Admin || wanted.devices->empty() || wanted.devices->size() > kMostDevices)) {
    return fail(ErrorCode::InvalidArgument,
                "A token is limited to 1 to 100 devices, and an admin to none: it could make itself another token.",
                {{"/devices", "1 to 100 names; none for an admin."}});
  }
  if (wanted.expires_at && *wanted.expires_at <= now) {
    return fail(ErrorCode::InvalidArgument, "The token would have expired already.", {{"/expires_in_s", "Above 0."}});
  }
  if (!has_admin() && wanted.scope != Scope::Admin) {
    return fail(ErrorCode::Conflict,
                "The first token must have the scope admin: with it authentication is on, and nobody else could make "
                "another one.",
                {{"scope", std::string(name_of(wanted.scope))}});
  }
  const auto all = kept();
  const auto live =
      std::count_if(all->tokens.begin(), all->tokens.end(), [&](const Token& token) { return is_live(token, now); });
  if (live >= options_.budgets.tokens) {
    return fail(ErrorCode::LimitExceeded, "There are as many valid tokens as there may be " +
                                              naming_budget("tokens", options_.budgets.tokens) + "; revoke one.");
  }
  if (std::ssize(all->tokens) >= options_.budgets.tokens_ever) {
    return fail(ErrorCode::LimitExceeded, "There are as many tokens as there may be, with those revoked or expired " +
                                              naming_budget("tokens_ever", options_.budgets.tokens_ever) + ".");
  }
  IssuedToken issued;
  issued.secret = make_secret();
  issued.token.id = make_token_id();
  issued.token.name = wanted.name;
  issued.token.scope = wanted.scope;
  issued.token.devices = wanted.devices;
  issued.token.expires_at = wanted.expires_at;
  issued.token.secret_sha256 = sha256_hex(issued.secret);
  auto added = store_.add_token(issued.token);
  if (!added) {
    return fail(added.error());
  }
  issued.token = std::move(*added);
  if (Status fresh = reload(); !fresh) {
    return fail(fresh.error());
  }
  return issued;
}

Result<Token> Gate::revoke(std::string_view id, bool even_last) {
  const std::lock_guard changing(changing_);
  const auto all = kept();
  const auto now = clock_.now();
  const Token* const token = all->find(id);
  const bool another_lasts = std::any_of(all->tokens.begin(), all->tokens.end(), [&](const Token& each) {
    return &each != token && each.scope == Scope::Admin && is_live(each, now + kShortestOfLastAdmin);
  });
  if (!even_last && token != nullptr && token->scope == Scope::Admin && is_live(*token, now) && !another_lasts) {
    return fail(ErrorCode::Conflict,
                "The token " + token->id +
                    " is the last admin that lasts another day: make another one before, or nobody could.",
                {{"token", token->id}});
  }
  auto revoked = store_.revoke_token(id);
  if (Status fresh = reload(); revoked && !fresh) {
    return fail(fresh.error());
  }
  return revoked;
}

Result<IssuedToken> Gate::rotate(std::string_view id) {
  const std::lock_guard changing(changing_);
  const auto all = kept();
  const Token* const token = all->find(id);
  if (token != nullptr && token->expires_at && *token->expires_at <= clock_.now()) {
    return fail(ErrorCode::Conflict, "The token " + token->id + " has expired; make another one.",
                {{"token", token->id}});
  }
  IssuedToken issued;
  issued.secret = make_secret();
  auto rotated = store_.rotate_token(id, sha256_hex(issued.secret));
  if (!rotated) {
    return fail(rotated.error());
  }
  issued.token = std::move(*rotated);
  if (Status fresh = reload(); !fresh) {
    return fail(fresh.error());
  }
  return issued;
}

Result<IssuedSession> Gate::open_session(std::string_view secret) {
  const std::lock_guard changing(changing_);
  const auto all = kept();
  const auto now = clock_.now();
  const Token* const token = is_secret(secret) ? token_of_secret(*all, secret) : nullptr;
  if (token == nullptr || !is_live(*token, now)) {
    return tl::unexpected(forbidden("This is no token of this daemon, or it was revoked or has expired."));
  }
  Caller who = caller_of_thread() != nullptr ? *caller_of_thread() : Caller{};
  who.principal = principal_of(*token);
  const ActingFor acting(who);  // the row of the audit log names the token
  IssuedSession issued;
  issued.secret = make_random_secret();
  const UtcMicros end = now + kSessionLifetime;
  issued.session = {sha256_hex(issued.secret), token->id, now, std::min(end, token->expires_at.value_or(end))};
  if (Status opened = store_.open_session(issued.session); !opened) {
    return fail(opened.error());
  }
  note_use(token->id);
  if (Status fresh = reload(); !fresh) {
    return fail(fresh.error());
  }
  return issued;
}

Status Gate::close_session(const Credentials& credentials) {
  const auto cookie = credentials.cookie ? session_of(*credentials.cookie, options_.secure) : std::nullopt;
  if (!cookie) {
    return {};
  }
  const std::lock_guard changing(changing_);
  if (Status closed = store_.close_session(sha256_hex(*cookie)); !closed) {
    return closed;
  }
  return reload();
}

void Gate::note_use(const std::string& token) {
  const std::lock_guard lock(mutex_);
  uses_[token] = clock_.now();
}

Status Gate::flush_use(bool now) {
  std::vector<std::pair<std::string, UtcMicros>> uses;
  {
    const std::lock_guard lock(mutex_);
    if (uses_.empty() || (!now && clock_.now() - flushed_at_ < kMinute)) {
      return {};
    }
    uses.assign(uses_.begin(), uses_.end());
    uses_.clear();
    flushed_at_ = clock_.now();
  }
  return store_.note_use(uses);
}

}  // namespace driftlab::server
