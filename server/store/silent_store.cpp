#include "server/store/silent_store.hpp"

#include <algorithm>
#include <string_view>

namespace driftlab::server {
namespace {

constexpr std::string_view kSilent = "silent";

}  // namespace

Error silent_store(std::string message, std::vector<ErrorField> fields) {
  fields.push_back({std::string(kSilent), "store"});
  return {ErrorCode::Io, std::move(message), std::move(fields)};
}

bool is_silent_store(const Error& error) {
  return error.code == ErrorCode::Io && std::any_of(error.fields.begin(), error.fields.end(),
                                                    [](const ErrorField& field) { return field.name == kSilent; });
}

}  // namespace driftlab::server
