#include "server/store/principal.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

constexpr std::array<std::string_view, 5> kScopes{"public", "read", "write", "run", "admin"};
constexpr std::string_view kForbidden = "forbidden";

thread_local const Caller* caller_now = nullptr;

}  // namespace

std::string_view name_of(Scope scope) { return kScopes.at(static_cast<std::size_t>(scope)); }

std::optional<Scope> parse_scope(std::string_view name) {
  const auto* const found = std::find(kScopes.begin(), kScopes.end(), name);
  return found == kScopes.end() ? std::nullopt : std::optional(static_cast<Scope>(found - kScopes.begin()));
}

ActingFor::ActingFor(const Caller& caller) : before_(caller_now) { caller_now = &caller; }

ActingFor::~ActingFor() { caller_now = before_; }

const Caller* caller_of_thread() { return caller_now; }

const std::vector<std::string>* devices_of_caller() {
  return caller_now != nullptr && caller_now->principal.devices ? &*caller_now->principal.devices : nullptr;
}

Status require_device(std::string_view name) {
  const std::vector<std::string>* const allowed = devices_of_caller();
  if (allowed == nullptr || std::find(allowed->begin(), allowed->end(), name) != allowed->end()) {
    return {};
  }
  std::string list;
  for (const std::string& each : *allowed) {
    list += (list.empty() ? "" : ", ") + each;
  }
  return tl::unexpected(forbidden("The token is limited to the devices " + list + "."));
}

Error forbidden(std::string message) {
  return {ErrorCode::InvalidArgument, std::move(message), {{std::string(kForbidden), "token"}}};
}

bool is_forbidden(const Error& error) {
  return std::any_of(error.fields.begin(), error.fields.end(),
                     [](const ErrorField& field) { return field.name == kForbidden; });
}

}  // namespace driftlab::server
