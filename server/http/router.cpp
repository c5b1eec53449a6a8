#include "server/http/router.hpp"

#include "core/signal/text.hpp"
#include "server/http/problem.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// The values of {…}, or nothing if the path has another shape.
std::optional<std::vector<std::string>> bind(const std::vector<std::string_view>& wanted,
                                             const std::vector<std::string_view>& given) {
  if (wanted.size() != given.size()) {
    return std::nullopt;
  }
  const auto fits = [](std::string_view segment, std::string_view value) {
    return segment.starts_with('{') ? !value.empty() : segment == value;
  };
  if (!std::equal(wanted.begin(), wanted.end(), given.begin(), fits)) {
    return std::nullopt;
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i].starts_with('{')) {
      values.emplace_back(given[i]);
    }
  }
  return values;
}

/// `devices` of /v1/devices/{id}; nothing where a pattern is shorter or takes any there.
std::optional<std::string_view> family_of(const std::vector<std::string_view>& segments) {
  return segments.size() > 2 && !segments[2].starts_with('{') ? std::optional(segments[2]) : std::nullopt;
}

}  // namespace

std::optional<Response> refuse_unknown_query(const Route& route, const Request& request) {
  for (std::size_t i = 0; i < request.query.size(); ++i) {
    const std::string& name = request.query[i].first;
    const bool known = std::find(route.query.begin(), route.query.end(), name) != route.query.end();
    const bool again = std::any_of(request.query.begin(), request.query.begin() + static_cast<std::ptrdiff_t>(i),
                                   [&](const auto& earlier) { return earlier.first == name; });
    if (again) {
      return problem_response(HttpFault::UnknownParameter, "The query parameter '" + name + "' is given twice.");
    }
    if (!known) {
      std::string list;
      for (const std::string_view allowed : route.query) {
        list += (list.empty() ? "" : ", ") + std::string(allowed);
      }
      return problem_response(HttpFault::UnknownParameter,
                              "The query parameter '" + name + "' is not known here; " +
                                  (list.empty() ? "this resource takes none." : "known are " + list + "."));
    }
  }
  return std::nullopt;
}

void Router::add(Route route) {
  segments_.push_back(split(route.pattern, '/'));
  const auto family = family_of(segments_.back());
  (family ? families_[*family] : others_).push_back(routes_.size());
  routes_.push_back(std::move(route));
}

void Router::set_scopes(const std::function<Scope(std::string_view operation_id)>& scope_of) {
  for (Route& route : routes_) {
    route.scope = scope_of(route.operation_id);
  }
}

void Router::try_routes(const std::vector<std::size_t>& candidates, std::string_view method,
                        const std::vector<std::string_view>& path, Match& match) const {
  for (const std::size_t i : candidates) {
    const Route& route = routes_[i];
    auto values = bind(segments_[i], path);
    if (!values) {
      continue;
    }
    match.allowed.push_back(route.method);
    const bool head = method == "HEAD" && route.method == "GET";
    if (match.route == nullptr && (route.method == method || head)) {
      match.route = &route;
      match.parameters = std::move(*values);
    }
  }
}

Router::Match Router::match(std::string_view method, std::string_view path) const {
  Match match;
  const auto given = split(path, '/');
  // A literal segment wins over a placeholder because literal routes are tried in the order they were added, and those
  // of the third segment's name before those that take any; no two patterns of the table overlap otherwise.
  if (const auto family = given.size() > 2 ? families_.find(given[2]) : families_.end(); family != families_.end()) {
    try_routes(family->second, method, given, match);
  }
  try_routes(others_, method, given, match);
  return match;
}

}  // namespace driftlab::server
