#pragma once
/// Requests and responses as handlers see them: plain values, free of sockets.
#include "core/signal/result.hpp"
#include "server/store/budgets.hpp"
#include "server/store/principal.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

/// A request whose header has passed the guard (server/http/guard.hpp) and matched a route.
struct Request {
  std::string method;
  std::string target;                                        ///< as sent
  std::string path;                                          ///< decoded
  std::vector<std::string> parameters;                       ///< values of {…} in the route, in order
  std::vector<std::pair<std::string, std::string>> query;    ///< decoded, in order
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
  std::string body;                                          ///< empty for uploads, which stream
  std::string request_id;
  Caller caller;                                ///< who asks, once the request was admitted
  const Budgets* budgets = &default_budgets();  ///< what an answer may take

  /// First value of a header (name in lower case), or nothing.
  [[nodiscard]] std::optional<std::string_view> header(std::string_view name) const;
  /// First value of a query parameter, or nothing.
  [[nodiscard]] std::optional<std::string_view> parameter(std::string_view name) const;
};

/// Bytes of a file, sent as they are read.
struct FileStretch {
  std::filesystem::path path;
  std::uint64_t first = 0;
  std::uint64_t length = 0;
};

struct Response {
  int status = 200;
  std::string content_type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
  std::optional<FileStretch> file = std::nullopt;  ///< stands for the body
  /// A job whose next event may change this answer: a client that sent `Prefer: wait=` gets it then.
  std::string pending_job;
  /// Never twice the same, so that it has no tag: what counts its own requests.
  bool volatile_body = false;
  /// Refused until that job has ended: nothing was done, so a request of any method may be repeated.
  bool undone = false;
  /// What failed in the daemon itself, as the log tells it; the body says it without the paths of files.
  std::optional<Error> failure = std::nullopt;

  [[nodiscard]] bool has_header(std::string_view name) const;
};

/// Seconds of the preference `wait=n` in a Prefer header (RFC 7240), at most a minute; nothing where it has none.
[[nodiscard]] std::optional<std::chrono::seconds> preferred_wait(const Request& request);

/// The media type of `offered` that an Accept header likes best (RFC 9110 section 12.5.1); the first for no header;
/// nothing if none is acceptable.
[[nodiscard]] std::optional<std::string_view> negotiate(std::optional<std::string_view> accept,
                                                        const std::vector<std::string_view>& offered);

/// Percent-decoding of a query component (`+` is a space) or a path; nothing if malformed.
[[nodiscard]] std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space);

/// The inverse: everything but letters, digits and `-._~` becomes %XX.
[[nodiscard]] std::string percent_encode(std::string_view text);

/// Splits a target into decoded path and query. Nothing if malformed. Tolerates characters such as `^` that people type
/// unescaped.
struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
};
[[nodiscard]] std::optional<Target> parse_target(std::string_view target);

}  // namespace driftlab::server
