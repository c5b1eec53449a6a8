#pragma once
/// The caller of a request: its scope, and the devices that it may see.
///
/// A request carries its caller from the check that admits it (server/auth/gate.hpp) to whatever it does. Below the
/// handlers the caller is that of the thread: a handler runs on one thread from its first line to its last, so that
/// the store can write, in the transaction of a change, who made it. Threads of the daemon itself have no caller.
#include "core/signal/result.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// What a token allows; each scope includes those before it. `Public` asks for no token at all.
enum class Scope { Public, Read, Write, Run, Admin };

/// `public`, `read`, `write`, `run`, `admin`.
[[nodiscard]] std::string_view name_of(Scope scope);
[[nodiscard]] std::optional<Scope> parse_scope(std::string_view name);

struct Principal {
  std::string token;                                ///< public id of the token; empty while no token is asked for
  std::string name;                                 ///< what the token is called
  Scope scope = Scope::Admin;                       ///< at most this
  std::optional<std::vector<std::string>> devices;  ///< names of the only devices there are for it; nothing: all
  std::string session = {};  ///< digest of the session that it came in by, the cookie of a dashboard; empty: none
};

struct Caller {
  Principal principal;
  std::string request_id;
  std::string address;
};

/// While it lives, this thread works for `caller`, which must outlive it.
class ActingFor {
 public:
  explicit ActingFor(const Caller& caller);
  ActingFor(const ActingFor&) = delete;
  ActingFor& operator=(const ActingFor&) = delete;
  ~ActingFor();

 private:
  const Caller* before_;
};

/// For whom this thread works; nullptr: for the daemon itself.
[[nodiscard]] const Caller* caller_of_thread();

/// The devices that this thread's caller is limited to; nullptr: it is not.
[[nodiscard]] const std::vector<std::string>* devices_of_caller();

/// Whether this thread's caller may use the device of that name, which need not exist: another one has the problem type
/// `forbidden`, and the sentence says nothing of what exists.
[[nodiscard]] Status require_device(std::string_view name);

/// An error that answers map to 403 (server/http/problem.hpp), and whether one is.
[[nodiscard]] Error forbidden(std::string message);
[[nodiscard]] bool is_forbidden(const Error& error);

}  // namespace driftlab::server
