#pragma once
/// Problem documents (RFC 9457) for every error the daemon gives, from one table.
///
/// Each entry of `problem_types` has a slug (the last part of `type`, a page served at /problems/<slug>), a status, a
/// title, whether trying again may help, and an explanation with its remedy. Every ErrorCode of core/ has the entry
/// whose slug is its name with dashes; the remaining entries are conditions of HTTP itself, listed in `HttpFault`.
#include "core/signal/result.hpp"
#include "server/http/message.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

struct ProblemType {
  std::string_view slug;
  int status;
  std::string_view title;
  bool retryable;
  std::string_view explanation;
};

/// What can go wrong in HTTP itself, before or beside the work asked for.
enum class HttpFault {
  BadRequest,
  HostNotAllowed,
  OriginNotAllowed,
  NoSuchResource,
  MethodNotAllowed,
  NotAcceptable,
  LengthRequired,
  BodyTooLarge,
  TargetTooLong,
  UnsupportedMediaType,
  UnknownParameter,
  PreconditionFailed,
  PreconditionRequired,
  HeaderTooLarge,
  DigestMismatch,
  ChecksumMismatch,
  IncompleteBody,
  IdempotencyKeyReused,
  IdempotencyInFlight,
  Busy,
  NotReady,
  PoolingPending,
  RangeNotSatisfiable,
  Unauthorized,
  Forbidden,
  TooManyRequests,
};

[[nodiscard]] const std::vector<ProblemType>& problem_types();
[[nodiscard]] const std::vector<HttpFault>& all_http_faults();
[[nodiscard]] const ProblemType& problem_type(ErrorCode code);
[[nodiscard]] const ProblemType& problem_type(HttpFault fault);
/// The entry of a slug, or nullptr.
[[nodiscard]] const ProblemType* find_problem_type(std::string_view slug);

/// The document without `instance` and `request_id`, which the connection adds, and without paths of the daemon's files
/// (server/store/told_error.hpp). Error fields named by JSON pointer become `errors`; the others (row, column,
/// parameter, ...) become members of `where`.
[[nodiscard]] std::string problem_document(const Error& error);

/// The answer: 403 where is_forbidden, 503 `not-ready` where is_silent_store. An error that is the daemon's own goes
/// with it whole, for the log.
[[nodiscard]] Response problem_response(const Error& error);
[[nodiscard]] Response problem_response(HttpFault fault, const std::string& detail);

}  // namespace driftlab::server
