#include "server/http/router.hpp"

#include "core/signal/text.hpp"

namespace driftlab::server {
namespace {

/// The values of {…}, or nothing if the path has another shape.
std::optional<std::vector<std::string>> bind(std::string_view pattern, std::string_view path) {
  const auto wanted = split(pattern, '/');
  const auto given = split(path, '/');
  if (wanted.size() != given.size()) {
    return std::nullopt;
  }
  std::vector<std::string> values;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i].starts_with('{')) {
      if (given[i].empty()) {
        return std::nullopt;
      }
      values.emplace_back(given[i]);
    } else if (wanted[i] != given[i]) {
      return std::nullopt;
    }
  }
  return values;
}

}  // namespace

void Router::add(Route route) { routes_.push_back(std::move(route)); }

Router::Match Router::match(std::string_view method, std::string_view path) const {
  Match match;
  // A literal segment wins over a placeholder because literal routes are tried in the order they were added; no two
  // patterns of the table overlap otherwise.
  for (const Route& route : routes_) {
    auto values = bind(route.pattern, path);
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
