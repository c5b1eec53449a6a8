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
  routes_.push_back(std::move(route));
}

void Router::set_scopes(const std::function<Scope(std::string_view operation_id)>& scope_of) {
  for (Route& route : routes_) {
    route.scope = scope_of(route.operation_id);
  }
}

Router::Match Router::match(std::string_view method, std::string_view path) const {
  Match match;
  const auto given = split(path, '/');
  // A literal segment wins over a placeholder because literal routes are tried in the order they were added; no two
  // patterns of the table overlap otherwise.
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    const Route& route = routes_[i];
    auto values = bind(segments_[i], given);
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
  return match;
}

}  // namespace driftlab::server
