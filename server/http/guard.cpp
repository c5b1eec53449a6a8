#include "server/http/guard.hpp"

#include <boost/beast/core/string.hpp>

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

/// The host of `scheme://host[:port]`; empty for `null` and whatever else is no such origin.
std::string_view origin_host(std::string_view origin) {
  const std::size_t slashes = origin.find("://");
  return slashes == std::string_view::npos ? std::string_view{} : host_name(origin.substr(slashes + 3));
}

bool is_allowed(std::string_view host, const GuardLimits& limits) {
  std::string name(host);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(limits.hosts.begin(), limits.hosts.end(), name) != limits.hosts.end();
}

bool is_sole(std::string_view name) {
  return name == "host" || name == "content-length" || name == "content-type" || name == "authorization" ||
         name == "transfer-encoding" || name == "origin";
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

GuardVerdict inspect(const HeadView& head, const GuardLimits& limits) {
  GuardVerdict verdict;
  std::vector<std::string_view> seen;
  std::optional<std::string_view> host;
  std::optional<std::string_view> origin;
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
    } else if (name == "transfer-encoding") {
      return refuse(HttpFault::LengthRequired, "Bodies need Content-Length; Transfer-Encoding is not taken.");
    } else if (name == "content-length") {
      const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), verdict.content_length);
      if (error != std::errc{} || stop != value.data() + value.size() || value.empty()) {
        return refuse(HttpFault::BadRequest, "Content-Length must be a whole number of bytes.");
      }
    } else if (name == "expect") {
      if (!boost::beast::iequals(value, "100-continue")) {
        return refuse(HttpFault::BadRequest, "The only expectation that is met is 100-continue.");
      }
      verdict.expects_continue = true;
    }
  }
  if (head.target.size() > limits.target_bytes) {
    return refuse(HttpFault::TargetTooLong, "The request target is longer than 8 KiB.");
  }
  if (!host) {
    return refuse(HttpFault::HostNotAllowed, "A Host header is needed.");
  }
  if (!is_allowed(host_name(*host), limits)) {
    return refuse(HttpFault::HostNotAllowed,
                  "The daemon does not answer for the host '" + std::string(host_name(*host)) + "'.");
  }
  const bool reads = head.method == "GET" || head.method == "HEAD";
  if (origin && !reads && !is_allowed(origin_host(*origin), limits)) {
    return refuse(HttpFault::OriginNotAllowed,
                  "A page of the origin '" + std::string(*origin) + "' may not change anything here.");
  }
  if (head.version != 11 && verdict.content_length > 0) {
    return refuse(HttpFault::BadRequest, "A request body needs HTTP/1.1.");
  }
  return verdict;
}

}  // namespace driftlab::server
