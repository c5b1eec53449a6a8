#include "server/http/guard.hpp"

#include "core/signal/text.hpp"
#include "server/http/names.hpp"
#include "server/store/budgets.hpp"

#include <algorithm>
#include <charconv>

namespace driftlab::server {
namespace {

std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) {
    return host.substr(0, std::min(host.find(']'), host.size() - 1) + 1);
  }
  return host.substr(0, host.find(':'));
}

/// `scheme://host[:port]` in lower case without the scheme's own port; empty for `null` and whatever else is no origin.
std::string whole_origin(std::string_view text) {
  std::string origin = lower_case(text);
  const std::size_t slashes = origin.find("://");
  if (slashes == std::string::npos) {
    return "";
  }
  for (const auto& [scheme, port] : {std::pair{"http://", ":80"}, std::pair{"https://", ":443"}}) {
    if (origin.starts_with(scheme) && origin.ends_with(port)) {
      origin.erase(origin.size() - std::string_view(port).size());
    }
  }
  return origin;
}

bool is_allowed(std::string_view host, const GuardLimits& limits) {
  return std::find(limits.hosts.begin(), limits.hosts.end(), lower_case(host)) != limits.hosts.end();
}

/// What a browser says about the page that asks.
struct Asking {
  std::string_view host;
  std::optional<std::string_view> origin;
  std::optional<std::string_view> site;  ///< Sec-Fetch-Site
};

/// Whether a page that is not this daemon's own asks. Browsers write Sec-Fetch-Site themselves (W3C Fetch Metadata), so
/// it decides where it is sent; behind a proxy that ends TLS the origin's scheme and port are the proxy's, and only its
/// host is compared then. Without it the whole origin must be the one that the request was sent to.
bool is_foreign(const Asking& asking, const GuardLimits& limits) {
  if (asking.site && *asking.site != "same-origin" && *asking.site != "none") {
    return true;
  }
  if (!asking.origin) {
    return false;
  }
  const std::string origin = whole_origin(*asking.origin);
  if (asking.site == "same-origin") {
    const std::size_t slashes = origin.find("://");
    return slashes == std::string::npos || !is_allowed(host_name(std::string_view(origin).substr(slashes + 3)), limits);
  }
  return origin != whole_origin((limits.secure ? "https://" : "http://") + std::string(asking.host));
}

bool is_sole(std::string_view name) {
  return name == "host" || name == "content-length" || name == "content-type" || name == "authorization" ||
         name == "transfer-encoding" || name == "origin" || name == "sec-fetch-site";
}

GuardVerdict refuse(HttpFault fault, const std::string& detail) {
  GuardVerdict verdict;
  verdict.refusal = problem_response(fault, detail);
  return verdict;
}

}  // namespace

bool is_request_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
           c == '-';
  });
}

HeadArrival look_at_head(std::string_view arrived, std::size_t from) {
  HeadArrival seen;
  for (std::size_t at = from < 2 ? 0 : from - 2; !seen.whole && !seen.folded; ++at) {
    while (at < arrived.size() && static_cast<unsigned char>(arrived[at]) >= ' ') {
      ++at;
    }
    if (at >= arrived.size()) {
      break;
    }
    const auto byte = static_cast<unsigned char>(arrived[at]);
    if (byte == '\n') {
      const std::string_view next = arrived.substr(at + 1);
      const bool crlf = at > 0 && arrived[at - 1] == '\r';
      seen.whole = !crlf || (next.size() > 1 && next[0] == '\r');
      seen.folded = crlf && (next.starts_with(' ') || next.starts_with('\t'));
    } else {
      seen.whole = byte != '\r' && byte != '\t';
    }
  }
  return seen;
}

GuardVerdict inspect(const HeadView& head, const GuardLimits& limits) {
  GuardVerdict verdict;
  std::vector<std::string_view> seen;
  std::optional<std::string_view> host;
  std::optional<std::string_view> origin;
  std::optional<std::string_view> site;
  for (const auto& [name, value] : head.headers) {
    if (is_sole(name)) {
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
        return refuse(name == "host" ? HttpFault::HostNotAllowed : HttpFault::BadRequest,
                      "The header " + name + " is given more than once.");
      }
      seen.push_back(name);
    }
    if (name == "host") {
      host = value;
    } else if (name == "origin") {
      origin = value;
    } else if (name == "sec-fetch-site") {
      site = value;
    } else if (name == "transfer-encoding") {
      if (head.version != 11 || !same_name(value, "chunked")) {
        return refuse(HttpFault::LengthRequired,
                      "Of transfer codings an upload takes chunked in HTTP/1.1; other bodies need Content-Length.");
      }
      verdict.chunked = true;
    } else if (name == "content-length") {
      const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), verdict.content_length);
      if (error != std::errc{} || stop != value.data() + value.size() || value.empty()) {
        return refuse(HttpFault::BadRequest, "Content-Length must be a whole number of bytes.");
      }
    } else if (name == "expect") {
      if (!same_name(value, "100-continue")) {
        return refuse(HttpFault::BadRequest, "The only expectation that is met is 100-continue.");
      }
      verdict.expects_continue = true;
    }
  }
  if (verdict.chunked && std::find(seen.begin(), seen.end(), "content-length") != seen.end()) {
    return refuse(HttpFault::LengthRequired, "Transfer-Encoding and Content-Length exclude each other.");
  }
  if (head.target.size() > limits.target_bytes) {
    return refuse(HttpFault::TargetTooLong,
                  "The request target is longer than it may be " +
                      naming_budget("target_bytes", static_cast<std::int64_t>(limits.target_bytes)) + ".");
  }
  if (!host) {
    return refuse(HttpFault::HostNotAllowed, "A Host header is needed.");
  }
  if (!is_allowed(host_name(*host), limits)) {
    return refuse(HttpFault::HostNotAllowed,
                  "The daemon does not answer for the host '" + std::string(host_name(*host)) + "'.");
  }
  const bool reads = head.method == "GET" || head.method == "HEAD";
  if (!reads && is_foreign({*host, origin, site}, limits)) {
    const std::string page = origin ? "the origin '" + std::string(*origin) + "'" : std::string("another site");
    return refuse(HttpFault::OriginNotAllowed, "A page of " + page + " may not change anything here.");
  }
  if (head.version != 11 && verdict.content_length > 0) {
    return refuse(HttpFault::BadRequest, "A request body needs HTTP/1.1.");
  }
  return verdict;
}

}  // namespace driftlab::server
