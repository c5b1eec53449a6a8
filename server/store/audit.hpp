#pragma once
/// The audit log: who changed what, as a chain of digests. Altering, removing or inserting a row makes every later
/// digest wrong.
///
/// digest = SHA-256 of previous, sequence, at_us, actor, action, object, request_id, address and detail, each written
/// as its length in bytes, a colon, its text and a comma. The first row's previous digest is 64 zeros. Rows taken off
/// the end leave a sound, shorter chain: keep the head elsewhere (every row is also a line of the daemon's log) and
/// compare.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace driftlab::server {

struct AuditRow {
  std::int64_t sequence = 0;  ///< 1, 2, 3, ... without a hole
  UtcMicros at = 0;
  std::string actor;       ///< public id of the token; `local` without authentication, `operator` for the command line
  std::string action;      ///< `recording.delete`
  std::string object;      ///< id of what was changed
  std::string request_id;  ///< empty for the command line
  std::string address;
  std::string detail;    ///< what the action did beside that, for example the scope of a token; may be empty
  std::string previous;  ///< digest of the row before
  std::string digest;
};

/// The digest that the row must have.
[[nodiscard]] std::string digest_of(const AuditRow& row);

/// How a chain was found.
struct AuditVerdict {
  std::int64_t rows = 0;  ///< that are sound, from the first on
  std::string head;       ///< digest of the last of them
  std::string fault;      ///< one sentence about the first row that is not; empty: the chain is whole
};

/// Walks a chain row by row.
class AuditWalk {
 public:
  AuditWalk();
  /// False at the first fault, and ever after.
  bool take(const AuditRow& row);
  [[nodiscard]] const AuditVerdict& verdict() const { return verdict_; }

 private:
  AuditVerdict verdict_;
};

}  // namespace driftlab::server
