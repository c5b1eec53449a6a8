// Who asks, and whether they may: before anything of a request is read or done but its header.
#include "server/api/api.hpp"
#include "server/http/problem.hpp"

namespace driftlab::server {
namespace {

Response unauthorized(const std::string& detail, bool brought_something) {
  Response response = problem_response(HttpFault::Unauthorized, detail);
  response.headers.emplace_back("WWW-Authenticate", std::string("Bearer realm=\"driftlab\"") +
                                                        (brought_something ? ", error=\"invalid_token\"" : ""));
  return response;
}

Response insufficient(const Principal& who, Scope needed) {
  const std::string name(name_of(needed));
  Response response =
      problem_response(HttpFault::Forbidden, "This needs the scope " + name + "; the token '" + who.name + "' has " +
                                                 std::string(name_of(who.scope)) + ".");
  response.headers.emplace_back("WWW-Authenticate",
                                "Bearer realm=\"driftlab\", error=\"insufficient_scope\", scope=\"" + name + '"');
  return response;
}

}  // namespace

std::optional<Response> admit(Gate& gate, const Route* route, Request& request) {
  if (route == nullptr || route->scope == Scope::Public) {
    if (gate.is_on()) {
      request.caller.principal = Principal{"", "nobody", Scope::Public, {}, ""};
    }
    return std::nullopt;
  }
  const auto authorization = request.header("authorization");
  const auto cookie = request.header("cookie");
  auto who = gate.identify({authorization, cookie});
  if (!who) {
    return unauthorized(who.error(), authorization || cookie);
  }
  request.caller.principal = std::move(*who);
  const Principal& principal = request.caller.principal;
  if (principal.scope < route->scope) {
    return insufficient(principal, route->scope);
  }
  // The guard has compared what a browser says of its page; here it must have said something.
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (!principal.session.empty() && !reads && !request.header("origin") && !request.header("sec-fetch-site")) {
    return problem_response(HttpFault::OriginNotAllowed,
                            "A change through a session needs the header Origin or Sec-Fetch-Site; programs send a "
                            "token instead.");
  }
  return std::nullopt;
}

}  // namespace driftlab::server
