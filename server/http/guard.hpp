#pragma once
/// The header guard: decides from the header alone, before a byte of the body is read, whether a request may go on.
///
/// Beast 1.81 accepts requests that proxies and servers read differently (request smuggling): `Transfer-Encoding` of
/// any kind, two `Host` headers, none, repeated `Content-Length`. The guard refuses them all, but for `chunked` alone,
/// which it reports: upload routes take it (server/http/chunked.hpp), others do not. It also refuses hosts the
/// daemon was not told to answer for (DNS rebinding) and changes that a browser sends for a page of another origin: an
/// origin is scheme, host and port, so a page on another port of this machine is another one. It is a pure function.
#include "server/http/problem.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

struct HeadView {
  unsigned version = 11;
  std::string_view method;
  std::string_view target;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case, in order, repeats kept
};

struct GuardLimits {
  std::size_t target_bytes = 8UL * 1024;
  std::vector<std::string> hosts;  ///< allowed names, lower case, without port
  bool secure = false;             ///< the daemon speaks TLS: its own origin begins with https
};

struct GuardVerdict {
  std::optional<Response> refusal;  ///< a problem; the connection closes after it
  std::uint64_t content_length = 0;
  bool expects_continue = false;
  bool chunked = false;  ///< the body is chunked, without a Content-Length beside it
};

/// What of a request has arrived: whether its header is whole, and whether a line of it goes on in the next one.
/// Folded lines (RFC 9112 section 5.2) are obsolete, and joined by Beast before the guard could see them.
struct HeadArrival {
  bool whole = false;   ///< its end is there, or something that no more bytes will mend
  bool folded = false;  ///< a line begins with a space or a tab
};
/// `from`: bytes that were looked at before; a line end among the last two of them is looked at again.
[[nodiscard]] HeadArrival look_at_head(std::string_view arrived, std::size_t from = 0);

[[nodiscard]] GuardVerdict inspect(const HeadView& head, const GuardLimits& limits);

/// `[A-Za-z0-9._-]{1,64}`: a request id that a client may choose.
[[nodiscard]] bool is_request_id(std::string_view text);

}  // namespace driftlab::server
