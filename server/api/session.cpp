#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"

namespace driftlab::server {
namespace {

std::string cookie_of(const Gate& gate, const std::string& secret, std::int64_t lifetime_s) {
  return std::string(session_cookie(gate.is_secure())) + "=" + secret +
         "; Path=/; Max-Age=" + std::to_string(lifetime_s) + "; HttpOnly; SameSite=Strict" +
         (gate.is_secure() ? "; Secure" : "");
}

Json session_json(const Principal& who) {
  return Json{{"authentication", who.token.empty()      ? "off"
                                 : !who.session.empty() ? "session"
                                                        : "token"},
              {"token", who.token.empty() ? Json(nullptr) : Json(who.token)},
              {"name", who.token.empty() ? Json(nullptr) : Json(who.name)},
              {"scope", name_of(who.scope)},
              {"devices", who.devices ? Json(*who.devices) : Json(nullptr)}};
}

Response kept_nowhere(Response response) {
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

Result<Response> open_session(ApiContext& context, const Request& request) {
  const auto secret = read_body(request, [](ObjectReader& reader, Faults&) { return reader.required_text("token"); });
  if (!secret) {
    return fail(secret.error());
  }
  if (!context.gate.is_on()) {
    return fail(ErrorCode::Conflict, "This daemon asks for no token, so there is nothing to sign in to.");
  }
  const auto opened = context.gate.open_session(*secret);
  if (!opened) {
    if (!is_forbidden(opened.error())) {
      return fail(opened.error());
    }
    Response refused = problem_response(HttpFault::Unauthorized, opened.error().message);
    refused.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"driftlab\", error=\"invalid_token\"");
    return refused;
  }
  const std::string cookie = std::string(session_cookie(context.gate.is_secure())) + "=" + opened->secret;
  const auto who = context.gate.identify({std::nullopt, cookie});
  if (!who) {
    return problem_response(HttpFault::Unauthorized, who.error());
  }
  Response response = kept_nowhere(json_response(201, session_json(*who)));
  const std::int64_t lifetime_s = (opened->session.expires_at - opened->session.created_at) / 1'000'000;
  response.headers.emplace_back("Set-Cookie", cookie_of(context.gate, opened->secret, lifetime_s));
  response.headers.emplace_back("Location", "/v1/session");
  return response;
}

Result<Response> close_session(ApiContext& context, const Request& request) {
  if (auto closed = context.gate.close_session({std::nullopt, request.header("cookie")}); !closed) {
    return fail(closed.error());
  }
  Response response;
  response.status = 204;
  response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("Set-Cookie", cookie_of(context.gate, "", 0));
  return response;
}

}  // namespace

void add_session_routes(Router& router, ApiContext& context) {
  Route open{"POST", "/v1/session", "openSession", {}, Handler([&](const Request& request) {
               return open_session(context, request);
             })};
  open.secret = true;
  router.add(std::move(open));
  router.add({"GET", "/v1/session", "getSession", {}, Handler([](const Request& request) -> Result<Response> {
                return kept_nowhere(json_response(200, session_json(request.caller.principal)));
              })});
  router.add({"DELETE", "/v1/session", "closeSession", {}, Handler([&](const Request& request) {
                return close_session(context, request);
              })});
}

}  // namespace driftlab::server
