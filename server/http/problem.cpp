#include "server/http/problem.hpp"

#include "server/store/silent_store.hpp"
#include "server/store/told_error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

using Json = nlohmann::ordered_json;

std::string slug_of(ErrorCode code) {
  std::string slug(name_of(code));
  std::replace(slug.begin(), slug.end(), '_', '-');
  return slug;
}

std::string_view slug_of(HttpFault fault) {
  switch (fault) {
    case HttpFault::BadRequest:
      return "bad-request";
    case HttpFault::HostNotAllowed:
      return "host-not-allowed";
    case HttpFault::OriginNotAllowed:
      return "origin-not-allowed";
    case HttpFault::NoSuchResource:
      return "no-such-resource";
    case HttpFault::MethodNotAllowed:
      return "method-not-allowed";
    case HttpFault::NotAcceptable:
      return "not-acceptable";
    case HttpFault::LengthRequired:
      return "length-required";
    case HttpFault::BodyTooLarge:
      return "body-too-large";
    case HttpFault::TargetTooLong:
      return "target-too-long";
    case HttpFault::UnsupportedMediaType:
      return "unsupported-media-type";
    case HttpFault::UnknownParameter:
      return "unknown-parameter";
    case HttpFault::PreconditionFailed:
      return "precondition-failed";
    case HttpFault::PreconditionRequired:
      return "precondition-required";
    case HttpFault::HeaderTooLarge:
      return "header-too-large";
    case HttpFault::DigestMismatch:
      return "digest-mismatch";
    case HttpFault::ChecksumMismatch:
      return "checksum-mismatch";
    case HttpFault::IncompleteBody:
      return "incomplete-body";
    case HttpFault::IdempotencyKeyReused:
      return "idempotency-key-reused";
    case HttpFault::IdempotencyInFlight:
      return "idempotency-in-flight";
    case HttpFault::Busy:
      return "busy";
    case HttpFault::NotReady:
      return "not-ready";
    case HttpFault::PoolingPending:
      return "pooling-pending";
    case HttpFault::RangeNotSatisfiable:
      return "range-not-satisfiable";
    case HttpFault::Unauthorized:
      return "unauthorized";
    case HttpFault::Forbidden:
      return "forbidden";
    case HttpFault::TooManyRequests:
      return "too-many-requests";
  }
  return "internal";
}

/// A field value that is a whole number appears as one; a code with zeros before it ("08001") is none.
Json field_value(const std::string& text) {
  std::int64_t number = 0;
  (void)std::from_chars(text.data(), text.data() + text.size(), number);
  return std::to_string(number) == text ? Json(number) : Json(text);
}

std::string render(const ProblemType& type, std::string_view code, const std::string& detail,
                   const std::vector<ErrorField>& fields) {
  Json document{{"type", "/problems/" + std::string(type.slug)},
                {"title", type.title},
                {"status", type.status},
                {"detail", detail},
                {"code", code},
                {"retryable", type.retryable}};
  Json errors = Json::array();
  Json where = Json::object();
  for (const ErrorField& field : fields) {
    if (field.name.starts_with('/')) {
      errors.push_back(Json{{"pointer", field.name == "/" ? "" : field.name}, {"code", code}, {"detail", field.value}});
    } else {
      where[field.name] = field_value(field.value);
    }
  }
  if (!where.empty()) {
    document["where"] = std::move(where);
  }
  document["errors"] = std::move(errors);
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Response respond(const ProblemType& type, std::string body) {
  Response response;
  response.status = type.status;
  response.content_type = "application/problem+json";
  response.body = std::move(body);
  if (type.status == 503 || type.status == 429) {
    response.headers.emplace_back("Retry-After", "1");
  }
  return response;
}

}  // namespace

const std::vector<ProblemType>& problem_types() {
  static const std::vector<ProblemType> types{
      // --- one per ErrorCode
      {"invalid-argument", 400, "Invalid argument", false,
       "A setting or parameter is missing, outside its range, or contradicts another. The detail names it; correct it "
       "and "
       "send the request again."},
      {"unknown-unit", 400, "Unknown unit", false,
       "A unit symbol is not one that driftlab knows. The detail lists the known ones; see /docs/units."},
      {"unknown-quantity", 400, "Unknown quantity", false,
       "A quantity is not one of the study specification. The detail lists the known ones."},
      {"unknown-condition", 400, "Unknown dynamic condition", false,
       "The dynamic condition is not one of the study specification. The detail lists the known ones."},
      {"unit-mismatch", 400, "Unit does not measure the quantity", false,
       "A unit was given for a quantity that it cannot measure, for example deg/s for a specific force."},
      {"unknown-column", 422, "Column not in the file", false,
       "The metadata name a column that the file does not have. The detail lists the columns that are there."},
      {"duplicate-column", 422, "Duplicate column", false,
       "Two columns of the file share a name, or two columns claim the same quantity and axis."},
      {"empty-input", 400, "Empty input", false, "No bytes were sent. Check the file name (curl needs @ before it)."},
      {"no-samples", 422, "No samples", false, "The file has a header and nothing under it."},
      {"too-few-samples", 422, "Too few samples", false,
       "The recording, or what trims and gaps leave of it, is too short for the analysis asked for."},
      {"ragged-row", 422, "Ragged row", false,
       "A row has more or fewer fields than the header. `where` gives row and count; the upload left nothing behind."},
      {"not-a-number", 422, "Text where a number belongs", false,
       "A field is not a decimal number. `where` gives row and column."},
      {"non-finite", 422, "NaN or infinity", false,
       "A field is NaN or infinite. `where` gives row and column. Remove the row, or leave it out with a time column "
       "that shows "
       "the gap."},
      {"out-of-range", 422, "Number out of range", false,
       "A number is too large for double precision, or its square is. `where` gives row and column."},
      {"non-monotonic-time", 422, "Time runs backwards", false,
       "The time column steps backwards at the row given in `where`. Sort or split the recording."},
      {"inconsistent-sampling", 422, "Sampling is not clear", false,
       "Neither a rate nor a time column was given, or the two contradict each other. State rate_hz, or a time column "
       "with its "
       "unit."},
      {"truncated", 422, "Data end early", false,
       "The data end before the header or the compression says they should."},
      {"shape-mismatch", 422, "Header and data disagree", false,
       "The header declares a shape that the bytes after it do not have."},
      {"unsupported-format", 415, "Not a recording format", false,
       "The bytes are no format that driftlab reads. It reads CSV with a header row and NumPy .npy, each also "
       "compressed by gzip, "
       "xz or zstd."},
      {"unsupported-type", 415, "Unsupported element type", false,
       "The format is known, but its element type or layout is not read. Save as floats or whole numbers."},
      {"corrupt-compression", 422, "Compressed data are damaged", false, "The compressed stream does not decompress."},
      {"decompression-limit", 413, "Expands beyond its budget", false,
       "The compressed stream expands far beyond what recordings do, and was given up. Upload it uncompressed if it is "
       "real."},
      {"limit-exceeded", 413, "Limit exceeded", false, "A stated limit is exceeded; the detail names it."},
      {"parse-error", 400, "Document cannot be read", false, "The JSON document or query does not parse."},
      {"io", 500, "Input/output error", true, "The operating system refused to read or write. See the daemon's log."},
      {"disk-full", 507, "Disk full", true,
       "There is no space left where the daemon keeps its data. Nothing was stored."},
      {"not-found", 404, "Not found", false, "The named object does not exist."},
      {"conflict", 409, "Conflict", false,
       "The object exists with other content, or changed in the meantime. The detail names the way out."},
      {"cancelled", 409, "Cancelled", false, "The work was cancelled on request."},
      {"internal", 500, "Internal error", true, "An invariant did not hold. Please report it with the request id."},
      // --- one per HttpFault
      {"bad-request", 400, "Bad request", false,
       "The request is not well-formed HTTP, or a header contradicts another."},
      {"host-not-allowed", 400, "Host not allowed", false,
       "The Host header is missing, repeated, or names a host that the daemon was not told to answer for "
       "(--allow-host)."},
      {"origin-not-allowed", 403, "Origin not allowed", false,
       "A browser sent this for a page of another origin, and pages may change only the daemon they come from."},
      {"no-such-resource", 404, "No such resource", false, "No resource has this path; /openapi.json lists them all."},
      {"method-not-allowed", 405, "Method not allowed", false,
       "The resource has no such method; Allow lists those it has."},
      {"not-acceptable", 406, "Not acceptable", false, "None of the media types in Accept is offered here."},
      {"length-required", 411, "Length required", false,
       "A body needs Content-Length. Uploads may come chunked instead, which is the one transfer coding that is "
       "taken."},
      {"body-too-large", 413, "Body too large", false, "The body is larger than this resource takes."},
      {"target-too-long", 400, "Target too long", false,
       "The request target is longer than the budget target_bytes allows."},
      {"unsupported-media-type", 415, "Unsupported media type", false,
       "The resource does not take bodies of this type."},
      {"unknown-parameter", 400, "Unknown query parameter", false,
       "The query holds a parameter that this resource does not have; the detail lists those it has."},
      {"precondition-failed", 412, "Precondition failed", false,
       "The object changed since it was read. Read it again and repeat the change with the new ETag."},
      {"precondition-required", 428, "Precondition required", false,
       "Changing or deleting needs If-Match with the ETag of the object as it was read."},
      {"header-too-large", 431, "Header too large", false, "The request header is larger than 16 KiB."},
      {"digest-mismatch", 400, "Digest mismatch", false,
       "The bytes received do not have the digest that Repr-Digest states. Nothing was stored; send them again."},
      {"checksum-mismatch", 460, "Checksum mismatch", true,
       "The bytes of this piece do not have the checksum that Upload-Checksum states (tus 1.0). The piece was taken "
       "back; send it again."},
      {"incomplete-body", 400, "Incomplete body", true,
       "The connection ended, or stalled, before all of the body had arrived. Nothing was stored."},
      {"idempotency-key-reused", 422, "Idempotency key used for another request", false,
       "The Idempotency-Key was used within 24 h for a request with another method, path or body."},
      {"idempotency-in-flight", 409, "Request still running", true,
       "A request with this Idempotency-Key is running; ask again in a moment."},
      {"busy", 503, "Busy", true, "Too much is being asked at once. Retry-After says when to come back."},
      {"not-ready", 503, "Not ready", true, "The daemon is starting, stopping, or its store or disk does not answer."},
      {"pooling-pending", 409, "Results are being pooled", true,
       "What was asked for reads a parameter table whose recordings are being fitted jointly. The detail names the "
       "job; "
       "ask again when it has ended, or send Prefer: wait=SECONDS."},
      {"range-not-satisfiable", 416, "Range not satisfiable", false,
       "Range asks for bytes behind the end; Content-Range says how many there are."},
      {"unauthorized", 401, "Token needed", false,
       "The daemon asks for a token, and none was sent, or one that is not known, was revoked or has expired. Send "
       "`Authorization: Bearer TOKEN`; see /docs/security."},
      {"forbidden", 403, "Not allowed", false,
       "The token does not allow this: its scope is too small, or it is limited to other devices. An admin makes "
       "another one; see /docs/security."},
      {"too-many-requests", 429, "Too many requests at once", true,
       "The token has as many requests under way as it may have. Wait for one of them to end."},
  };
  return types;
}

const std::vector<HttpFault>& all_http_faults() {
  static const std::vector<HttpFault> all = [] {
    std::vector<HttpFault> faults;
    for (int i = 0; i <= static_cast<int>(HttpFault::TooManyRequests); ++i) {
      faults.push_back(static_cast<HttpFault>(i));
    }
    return faults;
  }();
  return all;
}

const ProblemType* find_problem_type(std::string_view slug) {
  for (const ProblemType& type : problem_types()) {
    if (type.slug == slug) {
      return &type;
    }
  }
  return nullptr;
}

namespace {

/// Every code has a row (a test walks them); one without would be an internal error.
const ProblemType& type_or_internal(std::string_view slug) {
  const ProblemType* const type = find_problem_type(slug);
  const ProblemType* const shown = type != nullptr ? type : find_problem_type("internal");
  return shown != nullptr ? *shown : problem_types().front();
}

}  // namespace

const ProblemType& problem_type(ErrorCode code) { return type_or_internal(slug_of(code)); }

const ProblemType& problem_type(HttpFault fault) { return type_or_internal(slug_of(fault)); }

std::string problem_document(const Error& error) {
  const Error told = without_paths(error);
  return render(problem_type(told.code), name_of(told.code), told.message, told.fields);
}

Response problem_response(const Error& error) {
  if (is_forbidden(error)) {
    return problem_response(HttpFault::Forbidden, error.message);
  }
  Response response = is_silent_store(error) ? problem_response(HttpFault::NotReady, without_paths(error).message)
                                             : respond(problem_type(error.code), problem_document(error));
  if (error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull || error.code == ErrorCode::Internal) {
    response.failure = error;
  }
  return response;
}

Response problem_response(HttpFault fault, const std::string& detail) {
  const ProblemType& type = problem_type(fault);
  std::string code(type.slug);
  std::replace(code.begin(), code.end(), '-', '_');
  return respond(type, render(type, code, detail, {}));
}

}  // namespace driftlab::server
