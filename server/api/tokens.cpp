#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/auth/secret.hpp"
#include "server/store/damaged_row.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::int64_t kLongestLife = 10LL * 366 * 24 * 3600;  // s

Json moment(const std::optional<UtcMicros>& time) { return time ? Json(rfc3339(*time)) : Json(nullptr); }

Json to_json(const Token& token) {
  return Json{{"id", token.id},
              {"name", token.name},
              {"scope", name_of(token.scope)},
              {"devices", token.devices ? Json(*token.devices) : Json(nullptr)},
              {"created_at", rfc3339(token.created_at)},
              {"expires_at", moment(token.expires_at)},
              {"revoked_at", moment(token.revoked_at)},
              {"rotated_at", moment(token.rotated_at)},
              {"last_used_at", moment(token.last_used_at)}};
}

/// The one answer that has the secret.
Response issued_response(int status, const IssuedToken& issued) {
  Json document = to_json(issued.token);
  document["secret"] = issued.secret;
  Response response = json_response(status, document);
  response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("Location", "/v1/tokens/" + issued.token.id);
  return response;
}

std::optional<std::vector<std::string>> read_token_devices(const ObjectReader& reader, const Json* devices,
                                                           Faults& faults) {
  if (devices == nullptr || devices->is_null()) {
    return std::nullopt;
  }
  std::vector<std::string> names;
  bool sound = devices->is_array();
  if (sound) {
    for (const Json& name : *devices) {
      sound = sound && name.is_string();
      names.push_back(name.is_string() ? name.get<std::string>() : "");
    }
  }
  if (!sound) {
    faults.add(reader.pointer("devices"), ErrorCode::InvalidArgument, "The devices are a list of names.");
  }
  return names;
}

Result<Response> create_token(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  NewToken wanted;
  wanted.name = reader.required_text("name");
  const std::string scope = reader.required_text("scope");
  wanted.devices = read_token_devices(reader, reader.member("devices"), faults);
  const auto life = reader.integer("expires_in_s");
  reader.reject_unknown();
  wanted.scope = parse_scope(scope).value_or(Scope::Public);
  if (!scope.empty() && wanted.scope == Scope::Public) {
    faults.add("/scope", ErrorCode::InvalidArgument, "The scope of a token is read, write, run or admin.");
  }
  if (life && (*life < 1 || *life > kLongestLife)) {
    faults.add("/expires_in_s", ErrorCode::InvalidArgument, "A token lives for 1 s to ten years.");
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  if (life) {
    wanted.expires_at = context.clock.now() + *life * 1'000'000;
  }
  const auto issued = context.gate.create(wanted);
  if (!issued) {
    return fail(issued.error());
  }
  return issued_response(201, *issued);
}

/// Every token; of one whose row is damaged nothing is said.
Result<std::vector<Token>> sound_tokens(ApiContext& context) {
  auto all = context.gate.tokens();
  if (all) {
    const auto damaged = std::find_if(all->begin(), all->end(), [](const Token& each) { return each.is_damaged; });
    if (damaged != all->end()) {
      return fail(damaged_row("tokens", "token", damaged->id));
    }
  }
  return all;
}

Result<Token> token_named(ApiContext& context, const std::string& id) {
  auto all = sound_tokens(context);
  if (!all) {
    return fail(all.error());
  }
  for (Token& token : *all) {
    if (token.id == id) {
      return std::move(token);
    }
  }
  return fail(ErrorCode::NotFound, "There is no token \"" + id + "\".", {{"token", id}});
}

/// Tokens are few: the page is cut out of all of them, which come in the order of their making.
Result<Response> list_tokens(ApiContext& context, const Request& request) {
  const auto page = page_of(request, is_token_id);
  if (!page) {
    return fail(page.error());
  }
  auto all = sound_tokens(context);
  if (!all) {
    return fail(all.error());
  }
  if (page->order == PageOrder::NewestFirst) {
    std::reverse(all->begin(), all->end());
  }
  auto token = all->begin();
  if (!page->after.empty()) {
    token = std::find_if(all->begin(), all->end(), [&](const Token& each) { return each.id == page->after; });
    token += token == all->end() ? 0 : 1;
  }
  ListPage list(request, *page);
  while (token != all->end() && list.add(to_json(*token), token->id)) {
    ++token;
  }
  return list.response(token != all->end());
}

Result<Response> get_token(ApiContext& context, const Request& request) {
  return token_named(context, request.parameters[0]).map([](const Token& token) {
    return json_response(200, to_json(token));
  });
}

Result<Response> rotate_token(ApiContext& context, const Request& request) {
  return context.gate.rotate(request.parameters[0]).map([](const IssuedToken& issued) {
    return issued_response(200, issued);
  });
}

Result<Response> revoke_token(ApiContext& context, const Request& request) {
  return context.gate.revoke(request.parameters[0]).map([](const Token& token) {
    return json_response(200, to_json(token));
  });
}

}  // namespace

void add_token_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/tokens", "listTokens", {"limit", "cursor", "sort"}, Handler([&](const Request& request) {
                return list_tokens(context, request);
              })});
  Route create{"POST", "/v1/tokens", "createToken", {}, Handler([&](const Request& request) {
                 return create_token(context, request);
               })};
  create.secret = true;
  router.add(std::move(create));
  router.add({"GET", "/v1/tokens/{id}", "getToken", {}, Handler([&](const Request& request) {
                return get_token(context, request);
              })});
  Route rotate{"POST", "/v1/tokens/{id}/rotate", "rotateToken", {}, Handler([&](const Request& request) {
                 return rotate_token(context, request);
               })};
  rotate.secret = true;
  router.add(std::move(rotate));
  router.add({"POST", "/v1/tokens/{id}/revoke", "revokeToken", {}, Handler([&](const Request& request) {
                return revoke_token(context, request);
              })});
}

}  // namespace driftlab::server
